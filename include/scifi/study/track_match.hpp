// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <tuple>
#include <vector>

#include <scifi/event/track.hpp>
#include <scifi/study/true_track.hpp>
#include <scifi/track_model/helix_state.hpp>

namespace scifi::study {

/// How near a track must be to a particle, at the reference surface, to be its track.
struct match_window {
  double position = 6.0;   ///< mm, in (x, y)
  double momentum = 25.0;  ///< MeV/c, in (px, py); a line has no momentum to compare
  double mm_per_mev = 0.5; ///< so many mm count as 1 MeV/c where the nearest is looked for
};

/// Of what a track is: of a particle; of one that a nearer track has already; of none.
enum class track_kind { matched, duplicate, ghost };

/// Which track belongs to which particle.
struct track_match {
  std::vector<int> track_of;         ///< for each true track: index of its track, or -1
  std::vector<track_kind> kind_of;   ///< for each track
};

/// Pairs tracks with particles of the same tracker: each particle has at most one track and each track one particle, nearest pairs first.
/// Particles without a crossing of the reference surface take no part.
[[nodiscard]] inline track_match match(std::span<const true_track> particles, std::span<const track* const> tracks, const match_window& window = {}) {
  using m = momentum_state;
  track_match out{std::vector<int>(particles.size(), -1), std::vector<track_kind>(tracks.size(), track_kind::ghost)};
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (particles[i].reference() == nullptr) continue;
    const vector<double, 5> truth = particles[i].state();
    for (std::size_t j = 0; j < tracks.size(); ++j) {
      const vector<double, 5> off = tracks[j]->reference.mean - truth;
      const double apart = std::hypot(off[m::x], off[m::y]);
      const double turned = tracks[j]->shape == track_shape::line ? 0.0 : std::hypot(off[m::px], off[m::py]);
      if (apart < window.position && turned < window.momentum) pairs.emplace_back(apart / window.mm_per_mev + turned, i, j);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  for (const auto& [distance, i, j] : pairs) {
    if (out.track_of[i] >= 0 || out.kind_of[j] == track_kind::matched) continue;
    out.track_of[i] = static_cast<int>(j);
    out.kind_of[j] = track_kind::matched;
  }
  for (const auto& [distance, i, j] : pairs)
    if (out.kind_of[j] == track_kind::ghost) out.kind_of[j] = track_kind::duplicate;
  return out;
}

}  // namespace scifi::study
