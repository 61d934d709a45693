// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include <scifi/geometry/channel_id.hpp>
#include <scifi/readout_to_digit/readout.hpp>

namespace scifi {

/// What became of a cable that was to be connected.
enum class cabling_result {
  connected,
  repeated,       ///< just this connection is there already
  no_such_cable,  ///< the layout has no such read-out channel
  cable_taken,    ///< the cable leads to another detector channel
  channel_taken   ///< the detector channel has another cable
};

/// Which read-out channel belongs to which channel of the detector: at most one each way.
class cabling_map {
 public:
  explicit cabling_map(const readout_layout& layout = {}) : layout_(layout), channel_of_(layout.size()) {}

  /// Connects the two; changes nothing unless it returns `connected`.
  [[nodiscard]] cabling_result connect(const readout_channel& cable, const channel_id& id) {
    const std::optional<std::size_t> at = layout_.index(cable);
    if (!at) return cabling_result::no_such_cable;
    if (channel_of_[*at]) return *channel_of_[*at] == id ? cabling_result::repeated : cabling_result::cable_taken;
    if (!cable_of_.emplace(id, cable).second) return cabling_result::channel_taken;
    channel_of_[*at] = id;
    return cabling_result::connected;
  }

  /// The detector channel that a read-out channel belongs to; nothing where none is connected. Constant time.
  [[nodiscard]] std::optional<channel_id> channel_of(const readout_channel& cable) const {
    const std::optional<std::size_t> at = layout_.index(cable);
    return at ? channel_of_[*at] : std::nullopt;
  }
  /// The read-out channel of a detector channel; nothing where none is connected.
  [[nodiscard]] std::optional<readout_channel> cable_of(const channel_id& id) const {
    const auto found = cable_of_.find(id);
    return found == cable_of_.end() ? std::nullopt : std::optional(found->second);
  }

  /// The connected detector channels with their cables, in order of the channels.
  [[nodiscard]] const std::map<channel_id, readout_channel>& cables() const { return cable_of_; }
  [[nodiscard]] const readout_layout& layout() const { return layout_; }

 private:
  readout_layout layout_;
  std::vector<std::optional<channel_id>> channel_of_;
  std::map<channel_id, readout_channel> cable_of_;
};

}  // namespace scifi
