// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <scifi/study/binomial_interval.hpp>

using scifi::study::wilson_interval;

// R. G. Newcombe, Statistics in Medicine 17 (1998) 857, table I, method 3 (score without continuity correction), 95 %.
TEST_CASE("intervals are those of the published table", "[study]") {
  constexpr double two_sided_95 = 1.959963984540054;
  struct row {
    double found, expected, low, high;
  };
  for (const row& r : {row{81, 263, 0.2553, 0.3662}, row{15, 148, 0.0624, 0.1605}, row{0, 20, 0.0000, 0.1611}, row{1, 29, 0.0061, 0.1718}}) {
    CAPTURE(r.found, r.expected);
    const auto i = wilson_interval(r.found, r.expected, two_sided_95);
    CHECK(i.low == Approx(r.low).margin(0.00005));
    CHECK(i.high == Approx(r.high).margin(0.00005));
    const auto mirrored = wilson_interval(r.expected - r.found, r.expected, two_sided_95);
    CHECK(mirrored.high == Approx(1.0 - i.low));
    CHECK(mirrored.low == Approx(1.0 - i.high).margin(1e-12));
  }
}

TEST_CASE("without a trial nothing is known", "[study]") {
  CHECK(wilson_interval(0, 0).low == 0.0);
  CHECK(wilson_interval(0, 0).high == 1.0);
}
