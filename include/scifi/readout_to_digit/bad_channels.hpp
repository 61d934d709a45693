// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <scifi/readout_to_digit/readout.hpp>

namespace scifi {

/// The read-out channels whose counts are not to be used.
class bad_channels {
 public:
  explicit bad_channels(const readout_layout& layout = {}) : layout_(layout), bad_(layout.size()) {}

  /// False where the layout has no such channel. A channel may be marked again.
  [[nodiscard]] bool mark(const readout_channel& r) {
    const std::optional<std::size_t> at = layout_.index(r);
    if (!at) return false;
    marked_ += bad_[*at] ? 0 : 1;
    bad_[*at] = true;
    return true;
  }
  /// Constant time.
  [[nodiscard]] bool contains(const readout_channel& r) const {
    const std::optional<std::size_t> at = layout_.index(r);
    return at && bad_[*at];
  }
  /// Number of channels marked.
  [[nodiscard]] std::size_t size() const { return marked_; }

 private:
  readout_layout layout_;
  std::vector<bool> bad_;
  std::size_t marked_ = 0;
};

}  // namespace scifi
