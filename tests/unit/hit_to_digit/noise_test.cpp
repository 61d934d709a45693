// SPDX-License-Identifier: MPL-2.0
#include <scifi/hit_to_digit/noise.hpp>

#include <cmath>
#include <vector>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("every channel has its chance of noise, evenly and with Poisson numbers", "[hit_to_digit]") {
  constexpr int channels = 214;
  constexpr int events = 20000;
  const thermal_noise noise{0.015};
  std::vector<int> hits(channels, 0);
  long noisy = 0, total = 0;
  for (int i = 0; i < events; ++i) {
    random_stream random(1, static_cast<std::uint64_t>(i), 0);
    int last = -1;
    noise.for_each(channels, random, [&](int channel, int photo_electrons) {
      REQUIRE(channel > last);
      REQUIRE(channel < channels);
      REQUIRE(photo_electrons >= 1);
      last = channel;
      ++hits[static_cast<std::size_t>(channel)];
      ++noisy;
      total += photo_electrons;
    });
  }
  const double n = static_cast<double>(channels) * events;
  CHECK(std::abs(static_cast<double>(noisy) - 0.015 * n) < 5.0 * std::sqrt(0.015 * 0.985 * n));
  const double mean = -std::log(0.985);
  CHECK(std::abs(static_cast<double>(total) - mean * n) < 5.0 * std::sqrt(mean * n));
  double chi2 = 0.0;
  const double expected = 0.015 * events;
  for (const int h : hits) chi2 += (h - expected) * (h - expected) / (expected * 0.985);
  CHECK(std::abs(chi2 - channels) < 5.0 * std::sqrt(2.0 * channels));
}

TEST_CASE("a rate of zero makes no noise and a high rate almost always some", "[hit_to_digit]") {
  random_stream random(2, 0, 0);
  int seen = 0;
  thermal_noise{0.0}.for_each(1000, random, [&](int, int) { ++seen; });
  CHECK(seen == 0);
  thermal_noise{0.99}.for_each(1000, random, [&](int, int) { ++seen; });
  CHECK(std::abs(seen - 990) < 5.0 * std::sqrt(1000 * 0.99 * 0.01));
  thermal_noise{0.99}.for_each(0, random, [&](int, int) { FAIL("there is no channel"); });
}
