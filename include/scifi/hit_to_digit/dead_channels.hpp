// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <scifi/core/random.hpp>
#include <scifi/geometry/channel_id.hpp>
#include <scifi/geometry/tracker.hpp>

namespace scifi {

/// Channels that say nothing: their fibres or photon counters are broken, or their counts are not to be used.
class dead_channels {
 public:
  dead_channels() = default;
  /// In any order; a channel may be named again.
  explicit dead_channels(std::vector<channel_id> ids) : ids_(std::move(ids)) {
    std::sort(ids_.begin(), ids_.end());
    ids_.erase(std::unique(ids_.begin(), ids_.end()), ids_.end());
  }

  [[nodiscard]] bool contains(const channel_id& id) const { return std::binary_search(ids_.begin(), ids_.end(), id); }
  [[nodiscard]] std::size_t size() const { return ids_.size(); }
  [[nodiscard]] auto begin() const { return ids_.begin(); }
  [[nodiscard]] auto end() const { return ids_.end(); }

 private:
  std::vector<channel_id> ids_;
};

/// Each channel of the detector dead with the chance `share` (0 .. 1): a function of the seed and the channel alone, so that a larger share adds to a smaller.
[[nodiscard]] inline dead_channels drawn_dead_channels(const detector& where, double share, std::uint64_t seed) {
  constexpr std::uint32_t dead_stage = 254;
  std::vector<channel_id> ids;
  for (const tracker& t : where.trackers)
    for (const station& s : t.stations)
      for (std::size_t p = 0; p < s.planes.size(); ++p)
        for (int channel = 0; channel < s.planes[p].channels; ++channel) {
          const channel_id id{t.id, s.id, static_cast<int>(p), channel};
          if (random_stream(seed, 0, dead_stage, static_cast<std::uint32_t>(tspc(id))).uniform() < share) ids.push_back(id);
        }
  return dead_channels(std::move(ids));
}

}  // namespace scifi
