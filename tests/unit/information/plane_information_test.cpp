// SPDX-License-Identifier: MPL-2.0
#include <scifi/information/plane_information.hpp>

#include <cmath>
#include <cstddef>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("a doublet of MICE fibres says 0.0945 mm where two channels overlap and 1.4 mm elsewhere", "[information]") {
  const doublet_information said;
  const detector where = mice::trackers();
  for (const plane& p : where.trackers[mice::downstream].stations[1].planes) {
    // The middle of a channel, and the border between two.
    CHECK(said.variance(p, p.alpha(57.0)) == Approx(1.4 * 1.4 / 12.0).epsilon(1e-3));
    CHECK(said.variance(p, p.alpha(57.5)) == Approx(0.0945 * 0.0945 / 12.0).epsilon(1e-3));
    int shared = 0;
    constexpr int steps = 100000;
    for (int i = 0; i < steps; ++i) shared += said.variance(p, p.alpha(40.0 + 10.0 * i / steps)) < 0.01;
    CHECK(static_cast<double>(shared) / steps == Approx(0.0945 / 1.4945).epsilon(3e-3));  // counted in steps of a hundredth of the strip
    CHECK(channel_information{}.variance(p, 3.21) == Approx(1.4945 * 1.4945 / 12.0).epsilon(1e-12));
  }
}
