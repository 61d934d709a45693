// SPDX-License-Identifier: MPL-2.0
#include <scifi/track_model/slope_state.hpp>

#include <scifi/core/linalg.hpp>

#include "state_space_laws.hpp"

using ss = scifi::slope_state;

TEST_CASE("slope_state names every component once, with unit and title", "[track_model]") {
  scifi::test::check_state_space<ss>();
  CHECK(ss::names[ss::x] == "x");
  CHECK(ss::names[ss::tx] == "tx");
  CHECK(ss::names[ss::y] == "y");
  CHECK(ss::names[ss::ty] == "ty");
  CHECK(ss::names[ss::q_over_pz] == "q_over_pz");
  CHECK(ss::units[ss::y] == "mm");
  CHECK(ss::units[ss::ty] == "1");
  CHECK(ss::units[ss::q_over_pz] == "e/(MeV/c)");
}

TEST_CASE("components of a slope_state are reached by name", "[track_model]") {
  const scifi::vector<double, 5> v(1.0, 0.1, 2.0, 0.2, 0.005);
  CHECK(v[ss::y] == 2.0);
  CHECK(v[ss::ty] == 0.2);
  CHECK(v[ss::q_over_pz] == 0.005);
}
