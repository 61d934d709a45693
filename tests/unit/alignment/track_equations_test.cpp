// SPDX-License-Identifier: MPL-2.0
#include <scifi/alignment/track_equations.hpp>

#include <array>

#include "support/catch.hpp"

using namespace scifi::alignment;

TEST_CASE("the equations of a track come back as they were put in, also after it was cleared", "[alignment]") {
  track_equations track;
  for (int turn = 0; turn < 2; ++turn) {
    track.clear(2);
    CHECK(track.size() == 0);
    const std::array<double, 2> first{1.0, 2.0}, second{3.0, 4.0};
    const std::array<coefficient, 3> moved{{{5, 0.5}, {1, 0.25}, {7, -1.0}}};
    track.add(0.1, 0.2, first, std::span(moved).first(2));
    track.add(0.3, 0.4, second, std::span(moved).last(1));
    track.add_wide_prior(-1.0, 10.0, first);
    REQUIRE(track.size() == 3);
    CHECK(track.local_parameters() == 2);
    CHECK(track.wide_priors() == 1);
    CHECK(track.global().size() == 3);
    CHECK(track[0].residual == 0.1);
    CHECK(track[0].sigma == 0.2);
    CHECK(track[0].local[1] == 2.0);
    REQUIRE(track[0].global.size() == 2);
    CHECK(track[0].global[0].parameter == 5);
    CHECK(track[1].local[0] == 3.0);
    REQUIRE(track[1].global.size() == 1);
    CHECK(track[1].global[0].parameter == 7);
    CHECK(track[1].global[0].value == -1.0);
    CHECK(track[2].global.empty());
  }
}
