// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include <scifi/event/hit.hpp>

namespace scifi {

/// Which hits made a digit. Kept apart from the digits, so that nothing of the truth reaches the reconstruction; a noise digit has no hits.
class digit_sources {
 public:
  explicit digit_sources(std::vector<hit> hits) : hits_(std::move(hits)) {
    std::stable_sort(hits_.begin(), hits_.end(), [](const hit& a, const hit& b) { return a.id < b.id; });
  }

  /// The hits in a channel, in the order in which they were made; valid as long as this object.
  [[nodiscard]] std::span<const hit> of(const channel_id& id) const {
    const auto [first, last] = std::equal_range(hits_.begin(), hits_.end(), hit{0, id, 0, 0.0, 0.0, {}, {}, 0, 0}, [](const hit& a, const hit& b) { return a.id < b.id; });
    return {first, last};
  }

 private:
  std::vector<hit> hits_;
};

}  // namespace scifi
