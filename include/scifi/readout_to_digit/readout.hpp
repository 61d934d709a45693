// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <optional>
#include <vector>

namespace scifi {

/// Where a signal is digitised: board (0..), bank of that board (0..), channel of that bank (0..).
struct readout_channel {
  int board = 0;
  int bank = 0;
  int channel = 0;
  friend constexpr auto operator<=>(const readout_channel&, const readout_channel&) = default;
};

/// What the ADC of one read-out channel says in one event.
struct raw_count {
  readout_channel from;
  int adc = 0;  ///< counts, pedestal included
};

/// One event as the read-out delivers it. Hand it back in for the next event: its memory is reused.
struct raw_event {
  long number = 0;
  std::vector<raw_count> counts;
};

/// How many of each there are. Defaults: the read-out of the MICE trackers, 8-bit ADCs on 16 boards of four banks of 128 channels.
struct readout_layout {
  int boards = 16;
  int banks = 4;       ///< of a board
  int channels = 128;  ///< of a bank
  int largest_count = 255;

  /// Read-out channels altogether.
  [[nodiscard]] constexpr std::size_t size() const { return static_cast<std::size_t>(all_banks()) * static_cast<std::size_t>(channels); }
  /// Banks of all boards together.
  [[nodiscard]] constexpr int all_banks() const { return boards * banks; }
  [[nodiscard]] constexpr bool contains(const readout_channel& r) const {
    return r.board >= 0 && r.board < boards && r.bank >= 0 && r.bank < banks && r.channel >= 0 && r.channel < channels;
  }
  /// Place in a table of `size()` entries; nothing for a channel that does not exist.
  [[nodiscard]] constexpr std::optional<std::size_t> index(const readout_channel& r) const {
    if (!contains(r)) return std::nullopt;
    return (static_cast<std::size_t>(r.board) * static_cast<std::size_t>(banks) + static_cast<std::size_t>(r.bank)) * static_cast<std::size_t>(channels) +
           static_cast<std::size_t>(r.channel);
  }
  /// The channel of a bank that is counted through all boards (bank = banks * board + bank of the board), as calibrations and lists of bad
  /// channels have it; nothing where it does not exist.
  [[nodiscard]] constexpr std::optional<readout_channel> counted_through(int bank, int channel) const {
    if (bank < 0 || bank >= all_banks() || channel < 0 || channel >= channels) return std::nullopt;
    return readout_channel{bank / banks, bank % banks, channel};
  }
};

}  // namespace scifi
