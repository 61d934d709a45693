// SPDX-License-Identifier: MPL-2.0
#include <scifi/material/landau_loss.hpp>

#include <array>
#include <cmath>

#include <scifi/core/units.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/materials.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("a prepared slab gives Landau's most probable loss", "[material]") {
  // PDG 2024 eq. 34.12, written out.
  const slab s = whole(materials::polystyrene, 0.6273);
  for (const double p : {120.0, 200.0, 400.0}) {
    const auto c = crossing_particle_of(p, muon_plus, 1.1);
    const double gamma2 = 1.0 + square(p / muon_plus.mass);
    const double beta2 = 1.0 - 1.0 / gamma2;
    const double xi = 0.5 * 0.307075 * materials::polystyrene.z_over_a / beta2 * materials::polystyrene.density * 0.06273 * 1.1;
    const double i = materials::polystyrene.mean_excitation_energy;
    const double delta = density_effect(p / muon_plus.mass, materials::polystyrene.density_effect).value;
    const double expected = xi * (std::log(2.0 * 0.51099895 * beta2 * gamma2 / i) + std::log(xi / i) + 0.200 - beta2 - delta);
    const auto found = loss_in_landau_slabs(c, muon_plus, std::array{landau_slab_of(muon_plus, s, 1.0, 0.0)});
    CHECK(found.value == Approx(expected).epsilon(1e-6));  // K has six digits here
  }
}

TEST_CASE("a slab so thick that the mode would pass the mean gives the mean", "[material]") {
  const double p = 60.0;
  const slab thick = whole(materials::polystyrene, 20.0);
  const auto c = crossing_particle_of(p, muon_plus, 1.0);
  const auto mode = loss_in_landau_slabs(c, muon_plus, std::array{landau_slab_of(muon_plus, thick, 5.0, 0.0)});
  CHECK(mode.value == Approx(mean_energy_loss{}.loss(p, muon_plus, thick, 1.0).value).epsilon(1e-9));
}

TEST_CASE("nothing is lost in vacuum and in no thickness", "[material]") {
  const auto c = crossing_particle_of(200.0, muon_plus, 1.0);
  const std::array nothing{landau_slab_of(muon_plus, whole(materials::vacuum, 10.0), 1.0, 0.0), landau_slab_of(muon_plus, whole(materials::mylar, 0.0), 1.0, 0.0)};
  CHECK(loss_in_landau_slabs(c, muon_plus, nothing).value == 0.0);
}
