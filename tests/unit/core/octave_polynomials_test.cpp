// SPDX-License-Identifier: MPL-2.0
#include <scifi/core/octave_polynomials.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/catch.hpp"

using scifi::octave_polynomials;

TEST_CASE("polynomials over octaves are as exact as the function and its derivative", "[core]") {
  const octave_polynomials of_log([](double x) { return 1.0 + std::log(x); }, 0, 3);
  const octave_polynomials of_power([](double x) { return 1.0 / std::sqrt(x); }, -3, 6);
  double worst = 0.0, worst_slope = 0.0;
  for (double x = 1.0; x < 8.0; x *= 1.000313) {
    const auto a = of_log.at(x), b = of_power.at(x);
    REQUIRE((a.known && b.known));
    worst = std::max({worst, std::abs(a.value / (1.0 + std::log(x)) - 1.0), std::abs(b.value * std::sqrt(x) - 1.0)});
    worst_slope = std::max({worst_slope, std::abs(a.x_times_slope - 1.0), std::abs(b.x_times_slope * std::sqrt(x) / -0.5 - 1.0)});
  }
  CHECK(worst < 3e-15);
  CHECK(worst_slope < 1e-11);  // the rounding of values, over a piece a sixteenth wide
}

TEST_CASE("polynomials over octaves know nothing outside, at a step and where the function is not a number", "[core]") {
  const double step = 1.3;
  const octave_polynomials f([&](double x) { return x > 3.0 ? std::nan("") : x > step ? x + 1e-6 : x; }, 0, 2);
  CHECK_FALSE(f.at(step).known);
  CHECK(f.at(1.2).value == Approx(1.2).epsilon(1e-15));
  CHECK(f.at(1.4).value == Approx(1.4 + 1e-6).epsilon(1e-15));
  CHECK(f.at(2.99).known);
  CHECK_FALSE(f.at(3.01).known);
  for (const double x : {0.999, 4.0, 0.0, -1.5, std::numeric_limits<double>::infinity(), std::nan("")}) CHECK_FALSE(f.at(x).known);
  CHECK_FALSE(octave_polynomials{}.at(1.0).known);
}
