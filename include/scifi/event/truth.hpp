// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <vector>

#include <scifi/core/linalg.hpp>
#include <scifi/event/hit.hpp>

namespace scifi {

/// Where a simulated particle crosses the reference surface of a plane. Tracker frame, mm and MeV/c.
struct crossing {
  int particle = 0;  ///< number of the particle within its event
  int pdg_id = 0;
  int tracker = 0;
  int station = 1;
  int plane = 0;
  vector<double, 3> position = vector<double, 3>::Zero();
  vector<double, 3> momentum = vector<double, 3>::Zero();
};

/// What really happened in an event; the reconstruction never sees it.
struct truth {
  std::vector<crossing> crossings;  ///< in order of the flight, particle after particle
  std::vector<hit> hits;            ///< likewise

  /// Empties it but keeps the memory.
  void clear() {
    crossings.clear();
    hits.clear();
  }
};

}  // namespace scifi
