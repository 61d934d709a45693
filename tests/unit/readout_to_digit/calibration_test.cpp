// SPDX-License-Identifier: MPL-2.0
#include <scifi/readout_to_digit/calibration.hpp>

#include <limits>

#include "support/catch.hpp"

using scifi::adc_line;
using scifi::readout_calibration;

TEST_CASE("a line that cannot be is not taken", "[readout_to_digit]") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  readout_calibration calibration;
  for (const adc_line line : {adc_line{}, {0.0, 28.0}, {-1.0, 28.0}, {10.0, -0.5}, {nan, 28.0}, {10.0, nan}, {infinity, 28.0}, {10.0, infinity}}) {
    CHECK_FALSE(line.valid());
    CHECK_FALSE(calibration.set({0, 0, 0}, line));
  }
  CHECK(calibration.size() == 0);
  CHECK_FALSE(calibration.of({0, 0, 0}).has_value());
  CHECK(adc_line{10.0, 0.0}.valid());
}

TEST_CASE("each read-out channel has its own calibration", "[readout_to_digit]") {
  readout_calibration calibration;
  CHECK(calibration.set({15, 3, 127}, {14.81, 29.24}));
  CHECK(calibration.set({0, 0, 0}, {9.54, 26.58}));
  CHECK(calibration.set({0, 0, 0}, {9.55, 26.59}));
  CHECK_FALSE(calibration.set({16, 0, 0}, {9.54, 26.58}));
  CHECK_FALSE(calibration.set({0, 0, -1}, {9.54, 26.58}));
  CHECK(calibration.size() == 2);
  REQUIRE(calibration.of({15, 3, 127}).has_value());
  CHECK(calibration.of({15, 3, 127})->gain == 14.81);
  CHECK(calibration.of({0, 0, 0})->pedestal == 26.59);
  CHECK_FALSE(calibration.of({0, 0, 1}).has_value());
  CHECK_FALSE(calibration.of({16, 0, 0}).has_value());
}
