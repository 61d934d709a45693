// SPDX-License-Identifier: MPL-2.0
#include <scifi/core/gamma_probability.hpp>

#include <cmath>
#include <limits>

#include <boost/math/special_functions/gamma.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("the gamma probability agrees with Boost for any shape", "[core]") {
  for (const double shape : {0.05, 0.5, 1.0, 2.37, 5.0, 17.3, 150.0}) {
    for (const double ratio : {1e-6, 0.01, 0.3, 0.9, 1.0, 1.1, 2.0, 5.0}) {
      const double x = ratio * (shape + 1.0);
      INFO("shape " << shape << ", x " << x);
      CHECK(gamma_probability(shape, x) == Approx(boost::math::gamma_q(shape, x)).epsilon(1e-9));
    }
  }
}

TEST_CASE("at its ends the gamma probability is one and nought, elsewhere undefined", "[core]") {
  CHECK(gamma_probability(2.0, 0.0) == 1.0);
  CHECK(gamma_probability(2.0, std::numeric_limits<double>::infinity()) == 0.0);
  CHECK(std::isnan(gamma_probability(0.0, 1.0)));
  CHECK(std::isnan(gamma_probability(1.0, -1.0)));
  CHECK(std::isnan(gamma_probability(1.0, std::numeric_limits<double>::quiet_NaN())));
}
