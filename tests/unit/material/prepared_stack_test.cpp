// SPDX-License-Identifier: MPL-2.0
#include <scifi/material/prepared_stack.hpp>

#include <scifi/core/pack_math.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/materials.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/material/straggling.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

slab_stack<4> station() {
  slab_stack<4> stack;
  stack.add(whole(materials::mylar, 0.025)).add(whole(materials::polystyrene, 0.6273)).add(split(whole(materials::polystyrene, 0.6273), 3)).add(whole(materials::helium, 200.0));
  return stack;
}

template <class EnergyLoss, class Scattering, class Straggling>
void check(const EnergyLoss& loss, const Scattering& scattering, const Straggling& straggling) {
  const prepared_stack<EnergyLoss, Scattering, Straggling, 4> prepared(loss, scattering, straggling, muon_plus, station());
  CHECK_FALSE(prepared.empty());
  using numbers = pack<double, 4>;
  for (const double p : {60.0, 150.0, 300.0, 3000.0, 1e5}) {
    for (const double path : {1.0, 1.12}) {
      const auto crossing = crossing_particle_of(p, muon_plus, path);
      energy_loss<double> expected{0.0, 0.0, 0.0};
      double angle = 0.0, energy = 0.0;
      for (const slab& s : station()) {
        add_loss(expected, loss.loss(p, muon_plus, s, path));
        angle += scattering.variance(p, muon_plus, s, path);
        energy += straggling.variance(p, muon_plus, s, path);
      }
      const auto found = prepared.loss(crossing);
      CHECK(found.value == Approx(expected.value).epsilon(1e-12));
      CHECK(found.d_value_d_p == Approx(expected.d_value_d_p).epsilon(1e-9));
      CHECK(found.d_value_d_path_factor == Approx(expected.d_value_d_path_factor).epsilon(1e-12));
      CHECK(prepared.angle_variance(crossing) == Approx(angle).epsilon(1e-12));
      CHECK(prepared.energy_variance(crossing) == Approx(energy).epsilon(1e-12));
      const auto in_lanes = crossing_particle_of(numbers(p), muon_plus, numbers(path));
      CHECK(prepared.loss(in_lanes).value[3] == Approx(expected.value).epsilon(1e-12));
      CHECK(prepared.angle_variance(in_lanes)[0] == Approx(angle).epsilon(1e-12));
    }
  }
}

}  // namespace

TEST_CASE("what is prepared equals the policies asked slab by slab", "[material]") {
  check(median_energy_loss{5.0}, highland_scattering{}, landau_straggling{5.0});
  check(most_probable_energy_loss{}, highland_scattering{}, landau_straggling{});
  check(mean_energy_loss{}, highland_scattering{}, bohr_straggling{});  // two that know nothing of preparation
  check(no_energy_loss{}, no_scattering{}, no_straggling{});
}

TEST_CASE("an empty stack says so", "[material]") {
  const prepared_stack<mean_energy_loss, highland_scattering, bohr_straggling, 4> nothing({}, {}, {}, muon_plus, slab_stack<4>{});
  CHECK(nothing.empty());
}
