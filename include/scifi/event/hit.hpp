// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/linalg.hpp>
#include <scifi/geometry/channel_id.hpp>

namespace scifi {

/// Energy that one particle left in one fibre core.
struct hit {
  int particle = 0;  ///< number of the particle within its event
  channel_id id;     ///< the channel that reads the fibre
  int fibre = 0;     ///< number of the fibre in its plane
  double edep = 0.0;  ///< MeV
  double t = 0.0;     ///< ns, since the primary particle started
  vector<double, 3> position = vector<double, 3>::Zero();  ///< where the particle enters the core or is born in it, tracker frame, mm
  vector<double, 3> momentum = vector<double, 3>::Zero();  ///< there, tracker frame, MeV/c
  int parent = 0;  ///< number of the particle that made this one; 0 for a particle of the beam
  int pdg_id = 0;
};

}  // namespace scifi
