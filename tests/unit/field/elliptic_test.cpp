// SPDX-License-Identifier: MPL-2.0
#include <scifi/field/elliptic.hpp>

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include <cmath>
#include <initializer_list>
#include <limits>

#include <scifi/core/linalg.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

}  // namespace

TEST_CASE("Legendre's complete integrals are those of the standard library", "[field]") {
  for (const double kc : {1.0, 0.99999, 0.8, 0.3, 0.01}) {
    INFO("kc " << kc);
    const double m = 1.0 - kc * kc, k = std::sqrt(m);
    // Where kc is small, K = ln(4/kc) is not known better than k, by eps/kc^2 of the rounding of k.
    const double rounding = 16.0 * eps / (kc * kc);
    CHECK(complete_elliptic(kc, 1.0, 1.0, 1.0) == Approx(std::comp_ellint_1(k)).epsilon(rounding));
    CHECK(complete_elliptic(kc, 1.0, 1.0, kc * kc) == Approx(std::comp_ellint_2(k)).epsilon(rounding));
    for (const double p : {0.02, 0.5, 3.0}) CHECK(complete_elliptic(kc, p, 1.0, 1.0) == Approx(std::comp_ellint_3(k, 1.0 - p)).epsilon(rounding));
  }
}

TEST_CASE("the integral is linear in the coefficients of the cosine and the sine", "[field]") {
  const double both = complete_elliptic(0.4, 0.7, 2.0, -3.0);
  CHECK(both == Approx(2.0 * complete_elliptic(0.4, 0.7, 1.0, 0.0) - 3.0 * complete_elliptic(0.4, 0.7, 0.0, 1.0)).epsilon(1e-14));
  // With p = kc = 1 it is pi (a + b) / 4.
  CHECK(complete_elliptic(1.0, 1.0, 5.0, -2.0) == Approx(0.75 * constants::pi).epsilon(1e-15));
}

TEST_CASE("the difference of K and E keeps its digits where they cancel", "[field]") {
  for (const double m : {0.999, 0.5, 0.05}) {
    const double k = std::sqrt(m);
    const double direct = ((2.0 - m) * std::comp_ellint_1(k) - 2.0 * std::comp_ellint_2(k)) / (m * m);
    CHECK(elliptic_difference(std::sqrt(1.0 - m), m) == Approx(direct).epsilon(16.0 * eps / (m * m) + 1e-12));
  }
  // pi/16 (1 + 3/4 m + 75/128 m^2 + ...), from the series of K and E (DLMF 19.5.1, 19.5.2).
  for (const double m : {1e-3, 1e-8, 1e-17, 0.0}) {
    const double series = constants::pi / 16.0 * (1.0 + 0.75 * m + 75.0 / 128.0 * m * m);
    CHECK(elliptic_difference(std::sqrt(1.0 - m), m) == Approx(series).epsilon(4.0 * eps + m * m * m));
  }
}

TEST_CASE("dual numbers through the integrals give their derivatives", "[field]") {
  using dual = Eigen::AutoDiffScalar<vector<double, 1>>;
  for (const double kc : {0.9, 0.2}) {
    const dual at(kc, 1, 0);
    const double m = 1.0 - kc * kc, k = std::sqrt(m), K = std::comp_ellint_1(k), E = std::comp_ellint_2(k);
    // DLMF 19.4.1: dK/dk = (E - kc^2 K)/(k kc^2), and dk/dkc = -kc/k.
    const dual got = complete_elliptic(at, dual(1.0), dual(1.0), dual(1.0));
    CHECK(got.value() == Approx(K).epsilon(1e-14));
    CHECK(got.derivatives()[0] == Approx(-(E - kc * kc * K) / (m * kc)).epsilon(1e-12));
    // d((2 - m)K - 2E)/dm from DLMF 19.4.1 and 19.4.2: -K + (2 - m)(E - (1 - m)K)/(2m(1 - m)) - (E - K)/m.
    const double bracket = (2.0 - m) * K - 2.0 * E;
    const double by_m = -K + (2.0 - m) * (E - (1.0 - m) * K) / (2.0 * m * (1.0 - m)) - (E - K) / m;
    const dual m_at = dual(1.0) - at * at;
    CHECK(elliptic_difference(at, m_at).derivatives()[0] == Approx((by_m / (m * m) - 2.0 * bracket / (m * m * m)) * -2.0 * kc).epsilon(1e-11));
  }
}

TEST_CASE("outside of its range the integral is not a number", "[field]") {
  CHECK(std::isnan(complete_elliptic(0.5, -1.0, 1.0, 1.0)));
}
