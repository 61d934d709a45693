// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include <scifi/core/constants.hpp>
#include <scifi/core/random.hpp>
#include <scifi/particle_to_hit/moving_particle.hpp>

namespace scifi {

/// Mean life at rest, ns (PDG 2024): muons and charged pions; infinite for all others.
[[nodiscard]] inline double mean_life(const particle& hypothesis) {
  constexpr double of_muon = 2196.9811;
  constexpr double of_pion = 26.033;
  if (std::abs(hypothesis.pdg_id) == muon_minus.pdg_id) return of_muon;
  if (std::abs(hypothesis.pdg_id) == pion_plus.pdg_id) return of_pion;
  return std::numeric_limits<double>::infinity();
}

/// Momentum (MeV/c) in the laboratory of a particle of `mass` that has momentum `at_rest` in the rest frame of `parent`.
[[nodiscard]] inline vector<double, 3> boosted(const vector<double, 3>& at_rest, double mass, const moving_particle& parent) {
  // Along u = p/m of the parent: p' = p + u (E + u.p / (gamma + 1)) (Jackson, Classical Electrodynamics, eq. 11.19).
  const vector<double, 3> u = parent.momentum / parent.hypothesis.mass;
  const double gamma = std::sqrt(1.0 + u.squaredNorm());
  const double energy = std::hypot(at_rest.norm(), mass);
  return at_rest + u * (energy + u.dot(at_rest) / (gamma + 1.0));
}

/// Energy of the electron of a muon at rest over its largest value: density x^2 (3 - 2x) 2, 0 < x < 1 (Michel; PDG 2024, muon decay parameters,
/// rho = 3/4, electron mass and radiation left out, spins averaged).
[[nodiscard]] inline double michel_fraction(random_stream& random) {
  while (true) {
    const double x = random.uniform();
    if (random.uniform() < x * x * (3.0 - 2.0 * x)) return x;
  }
}

/// The charged particle that a decay leaves, at the place of its parent: an electron of a muon, a muon of a pion (branching fraction 0.9999, taken as one).
/// Its direction is isotropic in the parent's rest frame: the polarisation of muons is left out. Nothing for a stable particle.
[[nodiscard]] inline std::optional<moving_particle> charged_daughter(const moving_particle& parent, random_stream& random) {
  const double m = parent.hypothesis.mass;
  moving_particle out = parent;
  double momentum = 0.0;
  if (std::abs(parent.hypothesis.pdg_id) == muon_minus.pdg_id) {
    out.hypothesis = parent.hypothesis.charge > 0 ? positron : electron;
    const double largest = 0.5 * (m + out.hypothesis.mass * out.hypothesis.mass / m);
    const double energy = std::fmax(michel_fraction(random) * largest, out.hypothesis.mass);
    momentum = std::sqrt(energy * energy - out.hypothesis.mass * out.hypothesis.mass);
  } else if (std::abs(parent.hypothesis.pdg_id) == pion_plus.pdg_id) {
    out.hypothesis = parent.hypothesis.charge > 0 ? muon_plus : muon_minus;
    momentum = 0.5 * (m - out.hypothesis.mass * out.hypothesis.mass / m);
  } else {
    return std::nullopt;
  }
  const double cosine = random.uniform(-1.0, 1.0);
  const double sine = std::sqrt(1.0 - cosine * cosine);
  const double azimuth = random.uniform(0.0, 2.0 * constants::pi);
  out.momentum = boosted(momentum * vector<double, 3>(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine), out.hypothesis.mass, parent);
  return out;
}

}  // namespace scifi
