// SPDX-License-Identifier: MPL-2.0
#include <scifi/hit_to_digit/adc.hpp>

#include <cmath>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("an ADC without smearing rounds photo-electrons and counts down", "[hit_to_digit]") {
  random_stream random(1, 0, 0);
  adc_response adc;
  adc.resolution = 0.0;
  const adc_line c{9.78, 23.47};
  const adc_reading r = adc.read(7.9, c, random);  // 7 pe: 7 * 9.78 + 23.47 = 91.93
  CHECK(r.counts == 91);
  CHECK(r.npe == Approx((91.0 - 23.47) / 9.78));
}

TEST_CASE("less than one photo-electron is none", "[hit_to_digit]") {
  random_stream random(2, 0, 0);
  const adc_reading r = adc_response{}.read(0.99, {10.0, 28.0}, random);
  CHECK(r.npe == 0.0);
  CHECK(r.counts == 28);
}

TEST_CASE("the ADC saturates at eight bits and does not go below zero", "[hit_to_digit]") {
  random_stream random(3, 0, 0);
  const adc_reading r = adc_response{}.read(100.0, {10.0, 28.0}, random);
  CHECK(r.counts == 255);
  CHECK(r.npe == Approx(22.7));
  adc_response wild;
  wild.resolution = 100.0;
  for (int i = 0; i < 200; ++i) {
    const int counts = wild.read(1.0, {10.0, 28.0}, random).counts;
    CHECK(counts >= 0);
    CHECK(counts <= 255);
  }
}

TEST_CASE("the response of the photon counter has a width of one photo-electron", "[hit_to_digit]") {
  random_stream random(4, 0, 0);
  constexpr int n = 20000;
  double mean = 0.0, square = 0.0;
  for (int i = 0; i < n; ++i) {
    const double npe = adc_response{}.read(10.3, {10.0, 28.0}, random).npe;
    mean += npe / n;
    square += npe * npe / n;
  }
  // Rounding down to 0.1 photo-electrons takes 0.05 off the mean and adds 0.01/12 to the variance.
  CHECK(std::abs(mean - 9.95) < 5.0 / std::sqrt(static_cast<double>(n)));
  CHECK(std::abs(square - mean * mean - 1.0 - 0.01 / 12.0) < 5.0 * std::sqrt(2.0 / n));
}

TEST_CASE("a drawn calibration belongs to seed and channel and has its mean and width", "[hit_to_digit]") {
  const drawn_calibration calibration{5};
  double gain = 0.0, square = 0.0, pedestal = 0.0;
  int n = 0;
  for (int station = 1; station <= 5; ++station)
    for (int channel = 0; channel < 214; ++channel) {
      const adc_line c = calibration({1, station, 0, channel});
      CHECK(c.gain == calibration({1, station, 0, channel}).gain);
      gain += c.gain;
      square += c.gain * c.gain;
      pedestal += c.pedestal;
      ++n;
    }
  gain /= n;
  const double five = 5.0 / std::sqrt(static_cast<double>(n));
  CHECK(std::abs(gain - 9.5) < five * 0.6);
  CHECK(std::abs(square / n - gain * gain - 0.36) < five * 0.36 * std::sqrt(2.0));
  CHECK(std::abs(pedestal / n - 26.0) < five * 1.2);
  CHECK(drawn_calibration{6}({1, 1, 0, 0}).gain != calibration({1, 1, 0, 0}).gain);
  CHECK(uniform_calibration{{10.0, 28.0}}({0, 1, 2, 3}).pedestal == 28.0);
}
