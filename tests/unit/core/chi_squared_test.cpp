// SPDX-License-Identifier: MPL-2.0
#include <scifi/core/chi_squared.hpp>

#include <boost/math/distributions/chi_squared.hpp>

#include <cmath>
#include <limits>

#include "support/catch.hpp"

using scifi::chi_squared_probability;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

}  // namespace

TEST_CASE("the probability of chi squared agrees with Boost.Math", "[core]") {
  for (int ndf = 1; ndf <= 60; ++ndf) {
    const boost::math::chi_squared reference(ndf);
    for (const double chi2 : {1e-12, 1e-3, 0.1, 0.7, 1.0, 3.84, 10.0, 25.0, 59.9, 100.0, 300.0, 900.0}) {
      INFO("ndf " << ndf << " chi2 " << chi2);
      const double expected = cdf(complement(reference, chi2));
      // All terms are positive: each of ndf/2 products rounds twice, and exp(-x) carries the rounding of x.
      const double tolerance = 4.0 * eps * (ndf + chi2);
      CHECK(chi_squared_probability(chi2, ndf) == Approx(expected).epsilon(tolerance).margin(0.0));
    }
  }
}

TEST_CASE("the probability of chi squared meets the printed critical values", "[core]") {
  // NIST/SEMATECH e-Handbook of Statistical Methods, table 1.3.6.7.4, upper-tail critical values; the third decimal is rounded.
  struct row {
    int ndf;
    double probability, chi2;
  };
  for (const row& r : {row{1, 0.05, 3.841}, row{2, 0.10, 4.605}, row{5, 0.01, 15.086}, row{10, 0.05, 18.307}, row{25, 0.025, 40.646}, row{100, 0.001, 149.449}}) {
    CHECK(chi_squared_probability(r.chi2 - 0.0005, r.ndf) >= r.probability);
    CHECK(chi_squared_probability(r.chi2 + 0.0005, r.ndf) <= r.probability);
  }
}

TEST_CASE("the probability of chi squared is 1 at zero, 0 at infinity and not a number where it has no meaning", "[core]") {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const int ndf : {1, 2, 3, 6, 7, 30}) {
    CHECK(chi_squared_probability(0.0, ndf) == 1.0);
    CHECK(chi_squared_probability(infinity, ndf) == 0.0);
    CHECK(std::isnan(chi_squared_probability(-1e-9, ndf)));
    CHECK(std::isnan(chi_squared_probability(std::nan(""), ndf)));
  }
  CHECK(std::isnan(chi_squared_probability(1.0, 0)));
  CHECK(std::isnan(chi_squared_probability(1.0, -3)));
}
