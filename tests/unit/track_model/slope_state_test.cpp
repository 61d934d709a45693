// SPDX-License-Identifier: MPL-2.0
#include <scifi/track_model/slope_state.hpp>

#include <scifi/core/linalg.hpp>

#include "state_space_laws.hpp"

using s = scifi::slope_state;

TEST_CASE("slope_state names every component once, with unit and title", "[track_model]") {
  scifi::test::check_state_space<s>();
  CHECK(s::names[s::x] == "x");
  CHECK(s::names[s::tx] == "tx");
  CHECK(s::names[s::y] == "y");
  CHECK(s::names[s::ty] == "ty");
  CHECK(s::names[s::q_over_pz] == "q_over_pz");
  CHECK(s::units[s::y] == "mm");
  CHECK(s::units[s::ty] == "1");
  CHECK(s::units[s::q_over_pz] == "e/(MeV/c)");
}

TEST_CASE("components of a slope_state are reached by name", "[track_model]") {
  const scifi::vector<double, 5> v(1.0, 0.1, 2.0, 0.2, 0.005);
  CHECK(v[s::y] == 2.0);
  CHECK(v[s::ty] == 0.2);
  CHECK(v[s::q_over_pz] == 0.005);
}
