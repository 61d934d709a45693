// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/core/linalg.hpp>
#include <scifi/material/particle.hpp>

namespace scifi {

/// A particle in flight: what it is, where it is and how it moves. Tracker frame; mm, MeV/c, ns.
struct moving_particle {
  particle hypothesis = muon_plus;
  vector<double, 3> position = vector<double, 3>::Zero();
  vector<double, 3> momentum = vector<double, 3>::Zero();
  double t = 0.0;

  /// Total energy, MeV.
  [[nodiscard]] double energy() const { return std::hypot(momentum.norm(), hypothesis.mass); }
  /// Kinetic energy, MeV, without the cancellation of E - m.
  [[nodiscard]] double kinetic_energy() const { return momentum.squaredNorm() / (energy() + hypothesis.mass); }
};

}  // namespace scifi
