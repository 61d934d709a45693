// SPDX-License-Identifier: MPL-2.0
#include <scifi/field/interpolation.hpp>

#include <cmath>
#include <initializer_list>

#include "support/catch.hpp"

using namespace scifi;

namespace {

/// Sum of weights times f at -1, 0, 1, 2.
template <class F>
double sum(const std::array<double, 4>& weights, const F& f) {
  double out = 0.0;
  for (std::size_t i = 0; i < 4; ++i) out += weights[i] * f(static_cast<double>(i) - 1.0);
  return out;
}

}  // namespace

TEST_CASE("linear interpolation is exact for straight lines, cubic interpolation for parabolas, slopes included", "[field]") {
  const auto line = [](double t) { return 3.0 - 2.0 * t; };
  const auto parabola = [](double t) { return 3.0 - 2.0 * t + 0.7 * t * t; };
  for (const double t : {0.0, 0.2, 0.5, 0.93, 1.0}) {
    CHECK(sum(linear_interpolation::weights(t), line) == Approx(line(t)).epsilon(1e-15));
    CHECK(sum(linear_interpolation::slopes(t), line) == Approx(-2.0).epsilon(1e-15));
    CHECK(sum(cubic_interpolation::weights(t), parabola) == Approx(parabola(t)).epsilon(1e-15));
    CHECK(sum(cubic_interpolation::slopes(t), parabola) == Approx(-2.0 + 1.4 * t).epsilon(1e-14));
  }
}

TEST_CASE("the cubic interpolation and its slope go through the samples without a jump", "[field]") {
  const auto wild = [](double t) { return std::sin(5.0 * t) + std::exp(t); };
  const auto next = [&wild](double t) { return wild(t + 1.0); };
  CHECK(sum(cubic_interpolation::weights(1.0), wild) == Approx(wild(1.0)));
  CHECK(sum(cubic_interpolation::weights(0.0), next) == Approx(wild(1.0)));
  CHECK(sum(cubic_interpolation::slopes(1.0), wild) == Approx(sum(cubic_interpolation::slopes(0.0), next)));
}
