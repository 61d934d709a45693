// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <scifi/core/linalg.hpp>
#include <scifi/event/track.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/slope_state.hpp>

namespace scifi {

/// A fitted track as a polyline to draw, tracker frame, mm: it goes through the smoothed position at every point, and between two of them along the helix of
/// the one, which passes smoothly into the helix of the other. `field` as in helix_propagator, that of the fit; zero for straight tracks.
///
/// No piece turns by more than `most_turn` (rad), at most 256 pieces between two points. Points in order of z. A state that is not finite gives points that
/// are not.
[[nodiscard]] inline std::vector<vector<double, 3>> track_curve(std::span<const track_point> points, double field, double most_turn = 0.1) {
  using s = slope_state;
  constexpr int most_pieces = 256;
  const helix_propagator flight{field};
  std::vector<vector<double, 3>> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const track_point& b = points[i];
    if (i > 0) {
      const track_point& a = points[i - 1];
      const double dz = b.z - a.z;
      const double turn = std::abs(field * dz) * std::max(std::abs(a.smoothed.mean[s::q_over_pz]), std::abs(b.smoothed.mean[s::q_over_pz]));
      const int pieces = turn < most_turn * most_pieces ? std::max(1, static_cast<int>(std::ceil(turn / most_turn))) : most_pieces;
      for (int k = 1; k < pieces; ++k) {
        const double share = static_cast<double>(k) / pieces;
        const double weight = share * share * (3.0 - 2.0 * share);
        const vector<double, 5> from_a = flight.propagate(a.smoothed.mean, share * dz).state;
        const vector<double, 5> from_b = flight.propagate(b.smoothed.mean, (share - 1.0) * dz).state;
        const vector<double, 5> between = (1.0 - weight) * from_a + weight * from_b;
        out.emplace_back(between[s::x], between[s::y], a.z + share * dz);
      }
    }
    out.emplace_back(b.smoothed.mean[s::x], b.smoothed.mean[s::y], b.z);
  }
  return out;
}

}  // namespace scifi
