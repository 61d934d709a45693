// SPDX-License-Identifier: MPL-2.0
#include <scifi/particle_to_hit/transport_settings.hpp>

#include <scifi/material/materials.hpp>
#include <scifi/particle_to_hit/electron_loss.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("electrons are followed from a tenth of a core's diameter of range on", "[particle_to_hit]") {
  // Range as the integral of dT / (dE/dx), from 5 keV, where 1 um is left.
  double range = 0.001;
  constexpr double step = 1e-4;
  for (double t = 0.005; t < transport_settings{}.follow_electrons_from; t += step) range += step / electron_stopping_power(t + 0.5 * step, materials::polystyrene);
  CHECK(range == Approx(0.1 * fibre_doublet{}.core_diameter).epsilon(0.15));
}
