// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <scifi/core/constants.hpp>
#include <scifi/core/random.hpp>
#include <scifi/particle_to_hit/moving_particle.hpp>
#include <scifi/particle_to_hit/scattering_sampling.hpp>

namespace scifi {

/// Momentum (MeV/c) of an electron at rest that took the kinetic energy T (MeV) from `by`, with a random azimuth. Energy and momentum conservation give
/// cos = T (E + m_e) / (p_e p) to the direction of `by` (PDG 2024, section 34.2.7: cos = (T/p_e) (p_max/T_max)). T must not exceed the largest transfer.
[[nodiscard]] inline vector<double, 3> knocked_on_momentum(const moving_particle& by, double kinetic_energy, random_stream& random) {
  const double p = by.momentum.norm();
  const double p_electron = std::sqrt(kinetic_energy * (kinetic_energy + 2.0 * constants::electron_mass));
  const double cosine = kinetic_energy * (by.energy() + constants::electron_mass) / (p_electron * p);
  const double angle = std::acos(std::min(cosine, 1.0));
  const double azimuth = random.uniform(0.0, 2.0 * constants::pi);
  return turned_by(vector<double, 3>(by.momentum * (p_electron / p)), {angle * std::cos(azimuth), angle * std::sin(azimuth)});
}

}  // namespace scifi
