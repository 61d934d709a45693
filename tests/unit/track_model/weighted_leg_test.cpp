// SPDX-License-Identifier: MPL-2.0
#include <scifi/track_model/weighted_leg.hpp>

#include <scifi/material/energy_loss.hpp>
#include <scifi/material/materials.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/track_model/energy_loss_propagator.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/line_propagator.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

/// Highland's variance, polystyrene's times a factor: a stack of polystyrene among mylar is then weighted by hand.
struct favoured_polystyrene {
  using variance_of = scattering_angle;
  double factor = 1.0;
  template <scalar Scalar>
  [[nodiscard]] Scalar variance(const Scalar& p, const particle& hypothesis, const slab& s, const Scalar& path) const {
    return Scalar(s.medium.name == "polystyrene" ? factor : 1.0) * highland_scattering{}.variance(p, hypothesis, s, path);
  }
};

leg sandwich(bool polystyrene_first) {
  leg l;
  l.dz = 200.0;
  l.start.add(whole(polystyrene_first ? materials::polystyrene : materials::mylar, 2.0));
  l.gap.add(whole(materials::helium, 196.0));
  l.finish.add(whole(polystyrene_first ? materials::mylar : materials::polystyrene, 2.0));
  return l;
}

}  // namespace

TEST_CASE("a weight multiplies the scattering of one end of a leg and nothing else", "[track_model]") {
  const vector<double, 5> start = (vector<double, 5>() << 1.0, 0.2, 2.0, -0.1, 0.005).finished();
  const energy_loss_propagator flight{helix_propagator{0.9}, mean_energy_loss{}, muon_plus, 1};
  for (const bool first : {true, false}) {
    const leg way = sandwich(first);
    const auto moved = flight.propagate(start, way);
    const material_noise plain{favoured_polystyrene{}, bohr_straggling{}, muon_plus};
    const material_noise by_hand{favoured_polystyrene{7.0}, bohr_straggling{}, muon_plus};
    const weighted_leg weighted{way, first ? 7.0 : 1.0, first ? 1.0 : 7.0};
    const matrix<double, 5, 5> q = weighted_noise{plain}.covariance(start, weighted, moved);
    const matrix<double, 5, 5> expected = by_hand.covariance(start, way, moved);
    CHECK((q - expected).norm() < 1e-12 * expected.norm());
    CHECK((weighted_noise{plain}.covariance(start, weighted_leg{way}, moved) - plain.covariance(start, way, moved)).norm() == 0.0);
    // The mean flies as before.
    CHECK((weighted_propagator{flight}.propagate(start, weighted).state - moved.state).norm() == 0.0);
  }
}

TEST_CASE("legs of straight tracks are weighted alike", "[track_model]") {
  const vector<double, 4> start(1.0, 0.2, 2.0, -0.1);
  const leg way = sandwich(true);
  const kalman::propagated<double, 4> moved = kalman::propagate(leg_propagator{line_propagator{}}, start, way);
  const line_material_noise plain{favoured_polystyrene{}, muon_plus, 200.0};
  const line_material_noise by_hand{favoured_polystyrene{7.0}, muon_plus, 200.0};
  const matrix<double, 4, 4> q = weighted_noise{plain}.covariance(start, weighted_leg{way, 7.0, 1.0}, moved);
  const matrix<double, 4, 4> expected = by_hand.covariance(start, way);
  CHECK((q - expected).norm() < 1e-12 * expected.norm());
}
