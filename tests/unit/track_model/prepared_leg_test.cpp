// SPDX-License-Identifier: MPL-2.0
#include <scifi/track_model/prepared_leg.hpp>

#include <scifi/core/units.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/material/straggling.hpp>
#include <scifi/track_model/energy_loss_propagator.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/material_noise.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("a prepared leg moves a track and adds noise as the leg it was made from", "[track_model]") {
  leg way{-250.0, -1, {}, {}, {}, 700.0};
  way.start.add(whole(materials::mylar, 0.025)).add(whole(materials::polystyrene, 0.6273));
  way.gap.add(whole(materials::helium, 249.0));
  way.finish.add(whole(materials::polystyrene, 0.6273));
  const median_energy_loss loss{5.0};
  const highland_scattering scattering;
  const landau_straggling straggling{5.0};
  const energy_loss_propagator propagator{helix_propagator{3.0 * units::tesla}, loss, muon_plus, 1};
  const material_noise noise{scattering, straggling, muon_plus};
  const vector<double, 5> start(10.0, 0.2, -20.0, 0.1, 0.005);
  for (const bool with_start : {true, false}) {
    if (!with_start) way.start = {};
    const prepared_leg prepared(way, loss, scattering, straggling, muon_plus);
    CHECK(prepared.z == 700.0);
    const auto by_leg = propagator.propagate(start, way);
    const auto by_prepared = propagator.propagate(start, prepared);
    CHECK((by_prepared.state - by_leg.state).norm() <= 1e-13 * by_leg.state.norm());
    CHECK((by_prepared.jacobian - by_leg.jacobian).norm() <= 1e-12 * by_leg.jacobian.norm());
    const auto plain = noise.covariance(start, way, static_cast<const kalman::propagated<double, 5>&>(by_leg));
    const auto again = noise.covariance(start, prepared, by_prepared);
    CHECK((again - plain).norm() <= 1e-12 * plain.norm());
  }
}
