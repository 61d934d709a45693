// SPDX-License-Identifier: MPL-2.0
#include <scifi/particle_to_hit/knocked_on.hpp>

#include <cmath>

#include <scifi/material/kinematics.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("energy and momentum are conserved when an electron is knocked on", "[particle_to_hit]") {
  moving_particle m;
  m.momentum = {20.0, -30.0, 150.0};
  random_stream random(1, 0, 0);
  const double largest = ionisation_kinematics_of(m.momentum.norm(), m.hypothesis).largest_transfer;
  for (const double share : {0.01, 0.1, 0.5, 0.9, 1.0}) {
    const double kinetic_energy = share * largest;
    const vector<double, 3> e = knocked_on_momentum(m, kinetic_energy, random);
    CHECK(std::hypot(e.norm(), electron.mass) - electron.mass == Approx(kinetic_energy));
    // What is left has the muon's mass.
    const double energy_left = m.energy() - kinetic_energy;
    CHECK(energy_left * energy_left - (m.momentum - e).squaredNorm() == Approx(m.hypothesis.mass * m.hypothesis.mass).epsilon(1e-9));
  }
  CHECK(knocked_on_momentum(m, largest, random).normalized().dot(m.momentum.normalized()) == Approx(1.0));
}
