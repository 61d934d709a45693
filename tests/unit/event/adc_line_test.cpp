// SPDX-License-Identifier: MPL-2.0
#include <scifi/event/adc_line.hpp>

#include "support/catch.hpp"

using scifi::adc_line;

TEST_CASE("light is the counts above the pedestal over the gain", "[event]") {
  const adc_line line{8.0, 24.0};
  CHECK(line.npe(104) == 10.0);  // (104 - 24) / 8, exact in binary
  CHECK(line.npe(24) == 0.0);
  CHECK(line.npe(20) == -0.5);
}

TEST_CASE("all counts of an ADC come back from the light that they mean", "[event]") {
  for (const adc_line line : {adc_line{9.54, 26.58}, {24.63, 37.12}, {2.5, 0.0}, {1.0 / 3.0, 1.0 / 7.0}})
    for (int counts = 0; counts <= 255; ++counts) {
      CHECK(line.counts(line.npe(counts), 255) == counts);
      // Light that moved by less than half a count is still that count.
      CHECK(line.counts(line.npe(counts) + 0.49 / line.gain, 255) == counts);
      CHECK(line.counts(line.npe(counts) - 0.49 / line.gain, 255) == counts);
    }
}

TEST_CASE("counts stay in the range of the ADC", "[event]") {
  const adc_line line{10.0, 28.0};
  CHECK(line.counts(1000.0, 255) == 255);
  CHECK(line.counts(1.0e300, 255) == 255);
  CHECK(line.counts(-1000.0, 255) == 0);
}
