// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/core/linalg.hpp>
#include <scifi/event/truth.hpp>
#include <scifi/geometry/surface.hpp>
#include <scifi/material/particle.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/track_model/conversions.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/material_noise.hpp>

namespace scifi::study {

/// What a simulation tells of a particle inside a plane, where it recorded nothing.
struct true_state {
  vector<double, 5> mean;       ///< slope_state
  vector<double, 5> open;       ///< variance of the true state about `mean`: scattering that the crossings on both sides do not tell
};

/// The state of a particle in the middle of a plane, at z (mm, tracker frame), from its crossing of the surface in front of the plane, on the side of smaller
/// z, and that of the next plane, or nullptr where it has none. Both are moved to z as helices in the field ((MeV/c)/(e mm)).
///
/// What the material of the plane did in front of z and behind it is known only in sum. With variances V1 and V2 of the slopes (Highland) the state at z is
/// the one in front plus V1/(V1 + V2) of the difference, with variance V1 V2/(V1 + V2) (a Brownian bridge); with nothing behind, the one in front with variance V1.
/// No measurement tells more, so a fit carries this variance too: fit - mean has the stated variance less `open`.
[[nodiscard]] inline true_state true_state_at(const surface& plane, const crossing& in_front, const crossing* behind, int charge, double z, double field) {
  const auto moved = [&](const crossing& c) {
    vector<double, 5> there;
    there << c.position.x(), c.position.y(), c.momentum.x(), c.momentum.y(), c.momentum.z();
    return helix_propagator{field}.propagate<double>(momentum_to_slopes(there, charge).state, z - c.position.z()).state;
  };
  const double p = in_front.momentum.norm();
  const double path = p / std::abs(in_front.momentum.z());
  const particle kind = particle_from_pdg(in_front.pdg_id).value_or(muon_plus);
  const auto scattered_in = [&](const slab_stack<4>& stack) {
    double sum = 0.0;
    for (const slab& s : stack) sum += highland_scattering{}.variance(p, kind, s, path);
    return sum;
  };
  const double before = scattered_in(plane.below);
  const double after = scattered_in(plane.above);
  using s = slope_state;
  true_state out{moved(in_front), vector<double, 5>::Zero()};
  double angle = before;
  if (behind != nullptr) {
    const double both = before + after;
    const double share = both > 0.0 ? before / both : 0.5;
    out.mean += share * (moved(*behind) - out.mean);
    angle = share * after;
  }
  const matrix<double, 2, 2> slopes = slope_covariance(out.mean[s::tx], out.mean[s::ty], angle);
  out.open[s::tx] = slopes(0, 0);
  out.open[s::ty] = slopes(1, 1);
  return out;
}

}  // namespace scifi::study
