// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <optional>

#include <scifi/core/linalg.hpp>
#include <scifi/event/truth.hpp>
#include <scifi/study/true_track.hpp>
#include <scifi/track_model/conversions.hpp>
#include <scifi/track_model/helix_propagator.hpp>

namespace scifi::study {

/// State (slope_state) of a particle in the middle of plane number `plane` of its tracker, at z (mm, tracker frame), from its crossings of the surfaces
/// on both sides: those in front of this plane and of the next. Each is moved to z as a helix in the field ((MeV/c)/(e mm)); their mean halves what
/// the material of the plane did to the particle on either side of its middle. Where the next plane was not crossed or there is none, the crossing
/// in front is all there is. Nothing where the plane itself was not crossed.
[[nodiscard]] inline std::optional<vector<double, 5>> true_state_at(const true_track& particle, std::size_t plane, double z, double field) {
  if (plane >= particle.at.size() || particle.at[plane] == nullptr) return std::nullopt;
  const auto moved = [&](const crossing& c) {
    vector<double, 5> there;
    there << c.position.x(), c.position.y(), c.momentum.x(), c.momentum.y(), c.momentum.z();
    return helix_propagator{field}.propagate<double>(momentum_to_slopes(there, particle.charge).state, z - c.position.z()).state;
  };
  const vector<double, 5> in_front = moved(*particle.at[plane]);
  const crossing* const next = plane + 1 < particle.at.size() ? particle.at[plane + 1] : nullptr;
  if (next == nullptr) return in_front;
  return vector<double, 5>(0.5 * (in_front + moved(*next)));
}

}  // namespace scifi::study
