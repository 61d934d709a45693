// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <vector>

#include <scifi/core/linalg.hpp>
#include <scifi/event/hit.hpp>

namespace scifi {

/// Where a particle of the beam crosses the reference surface of a plane. Tracker frame, mm and MeV/c.
struct crossing {
  int particle = 0;  ///< number of the particle within its event
  int pdg_id = 0;
  int tracker = 0;
  int station = 1;
  int plane = 0;
  vector<double, 3> position = vector<double, 3>::Zero();
  vector<double, 3> momentum = vector<double, 3>::Zero();
};

/// How a particle came to be.
enum class particle_origin { beam, knocked_on, decay };

/// A particle at its birth. Tracker frame, mm, MeV/c and ns.
struct simulated_particle {
  int particle = 0;  ///< number within its event
  int parent = 0;    ///< number of the particle it comes from; 0 for the beam
  int pdg_id = 0;
  particle_origin origin = particle_origin::beam;
  double t = 0.0;
  vector<double, 3> position = vector<double, 3>::Zero();
  vector<double, 3> momentum = vector<double, 3>::Zero();
};

/// What really happened in an event; the reconstruction never sees it.
struct truth {
  std::vector<crossing> crossings;            ///< in order of the flight, particle after particle
  std::vector<hit> hits;                      ///< likewise; a particle's secondaries follow it
  std::vector<simulated_particle> particles;  ///< each after its parent
  int last_particle = 0;  ///< numbers of secondaries follow it: set it to the largest number of a beam particle before the first flight

  /// Empties it but keeps the memory.
  void clear() {
    crossings.clear();
    hits.clear();
    particles.clear();
    last_particle = 0;
  }
};

}  // namespace scifi
