// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/material/particle.hpp>
#include <scifi/material/prepared_stack.hpp>
#include <scifi/track_model/leg.hpp>

namespace scifi {

/// A leg with what the policies of material say of its slabs prepared for any momentum: the step of a fit that takes the same legs many times.
///
/// The propagator with energy loss and the noise of material take it as they take a `leg`; it must have been made with their policies and particle.
template <class EnergyLoss, class Scattering, class Straggling>
struct prepared_leg {
  double z;       ///< where the first surface is, mm
  double dz;      ///< signed distance, mm
  int direction;  ///< +1 or -1, of the step in z
  prepared_stack<EnergyLoss, Scattering, Straggling, 4> start;
  prepared_stack<EnergyLoss, Scattering, Straggling, 1> gap;
  prepared_stack<EnergyLoss, Scattering, Straggling, 4> finish;

  prepared_leg(const leg& from, const EnergyLoss& loss, const Scattering& scattering, const Straggling& straggling, const particle& hypothesis)
      : z(from.z),
        dz(from.dz),
        direction(from.direction),
        start(loss, scattering, straggling, hypothesis, from.start),
        gap(loss, scattering, straggling, hypothesis, from.gap),
        finish(loss, scattering, straggling, hypothesis, from.finish) {}
};

}  // namespace scifi
