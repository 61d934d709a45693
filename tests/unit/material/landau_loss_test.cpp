// SPDX-License-Identifier: MPL-2.0
#include <scifi/material/landau_loss.hpp>

#include <algorithm>
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

TEST_CASE("polynomials of a stack's loss are its formula, in every region of the density effect and where the loss is bounded", "[material]") {
  slab_stack<4> stack;
  stack.add(whole(materials::mylar, 0.025)).add(whole(materials::aluminium, 0.1)).add(whole(materials::polystyrene, 0.6273)).add(whole(materials::vacuum, 3.0));
  const auto prepared = median_energy_loss{5.0}.prepared(muon_plus, stack);
  std::array<landau_slab, 4> slabs;
  for (std::size_t i = 0; i < 4; ++i) slabs[i] = median_energy_loss{5.0}.prepared_slab(muon_plus, stack[i]);
  double worst = 0.0, worst_slope = 0.0;
  for (double p = 20.0; p < 4000.0; p *= 1.0007) {
    for (const double path : {1.0, 1.3}) {
      const auto c = crossing_particle_of(p, muon_plus, path);
      const auto found = prepared.loss(c), expected = loss_in_landau_slabs(c, muon_plus, slabs);
      worst = std::max({worst, std::abs(found.value / expected.value - 1.0), std::abs(found.d_value_d_path_factor / expected.d_value_d_path_factor - 1.0)});
      worst_slope = std::max(worst_slope, std::abs(found.d_value_d_p - expected.d_value_d_p) * p / expected.value);
    }
  }
  CHECK(worst < 1e-14);
  CHECK(worst_slope < 1e-11);
}
