// SPDX-License-Identifier: MPL-2.0
#include <scifi/information/mixture_spread.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <scifi/core/random.hpp>

#include "support/catch.hpp"
#include "support/sample.hpp"

using namespace scifi;

TEST_CASE("equal errors spread by their standard deviation", "[information]") {
  CHECK(mixture_spread(std::vector<double>{0.7, 0.7, 0.7}) == Approx(0.7).epsilon(1e-9));
  // Half of the tracks without any error: the central 68.27 % end where a normal one holds 36.54 %, at 0.47523 standard deviations.
  CHECK(mixture_spread(std::vector<double>{0.0, 1.0}) == Approx(0.47523).epsilon(1e-4));
}

TEST_CASE("the spread of a mixture is that of numbers drawn from it", "[information]") {
  const std::vector<double> sigmas{0.3, 0.5, 1.0, 4.0};
  random_stream random(11, 0, 0);
  test::sample drawn;
  constexpr int each = 50000;
  for (const double sigma : sigmas)
    for (int i = 0; i < each; ++i) drawn.add(sigma * random.normal());
  CHECK(mixture_spread(sigmas) == Approx(drawn.spread()).epsilon(8.0 * drawn.relative_error_of_spread()));
}

TEST_CASE("unknown errors count as infinite", "[information]") {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  CHECK(mixture_spread(std::vector<double>{1.0, 1.0, 1.0, 1.0, unknown}) > 1.3);
  CHECK(std::isnan(mixture_spread(std::vector<double>{1.0, unknown})));
  CHECK(std::isnan(mixture_spread(std::vector<double>{})));
}
