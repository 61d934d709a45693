// SPDX-License-Identifier: MPL-2.0
#include <scifi/particle_to_hit/moving_particle.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("energy and kinetic energy follow from mass and momentum", "[particle_to_hit]") {
  moving_particle m;
  m.hypothesis = {3.0, 1, 0, "toy"};
  m.momentum = {0.0, 0.0, 4.0};
  CHECK(m.energy() == Approx(5.0));  // 3-4-5
  CHECK(m.kinetic_energy() == Approx(2.0));
}

TEST_CASE("the kinetic energy of a slow particle keeps its digits", "[particle_to_hit]") {
  moving_particle m;
  m.hypothesis = {1.0, 1, 0, "toy"};
  m.momentum = {1e-9, 0.0, 0.0};
  CHECK(m.kinetic_energy() == Approx(0.5e-18).epsilon(1e-12));
}
