// SPDX-License-Identifier: MPL-2.0
#include <scifi/track_model/line_state.hpp>

#include <cstddef>

#include <scifi/track_model/slope_state.hpp>

#include "state_space_laws.hpp"

using scifi::line_state;
using scifi::slope_state;

TEST_CASE("line_state names every component once, with unit and title", "[track_model]") {
  scifi::test::check_state_space<line_state>();
  CHECK(line_state::names[line_state::ty] == "ty");
  CHECK(line_state::units[line_state::x] == "mm");
  CHECK(line_state::units[line_state::tx] == "1");
}

TEST_CASE("line_state is the head of slope_state", "[track_model]") {
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(line_state::names[i] == slope_state::names[i]);
    CHECK(line_state::units[i] == slope_state::units[i]);
  }
}
