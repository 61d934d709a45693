// SPDX-License-Identifier: MPL-2.0
#include <scifi/track_model/helix_state.hpp>

#include "state_space_laws.hpp"

using scifi::helix_state;
using scifi::momentum_state;

TEST_CASE("helix_state names every component once, with unit and title", "[track_model]") {
  scifi::test::check_state_space<helix_state>();
  CHECK(helix_state::names[helix_state::py] == "py");
  CHECK(helix_state::units[helix_state::px] == "MeV/c");
  CHECK(helix_state::units[helix_state::q_over_pz] == "e/(MeV/c)");
}

TEST_CASE("momentum_state names every component once, with unit and title", "[track_model]") {
  scifi::test::check_state_space<momentum_state>();
  CHECK(momentum_state::names[momentum_state::y] == "y");
  CHECK(momentum_state::names[momentum_state::pz] == "pz");
  CHECK(momentum_state::units[momentum_state::pz] == "MeV/c");
}
