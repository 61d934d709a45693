// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <compare>

namespace scifi {

/// Which read-out channel: tracker (0 upstream, 1 downstream), station (1..), plane (0..), channel (0..).
struct channel_id {
  int tracker = 0;
  int station = 1;
  int plane = 0;
  int channel = 0;
  friend constexpr auto operator<=>(const channel_id&, const channel_id&) = default;
};

/// The id as one decimal number `tspccc`: tracker, station, plane, channel in three digits; 110057 is tracker 1, station 1, plane 0, channel 57.
/// Valid for stations 1..9, planes 0..9, channels 0..999.
[[nodiscard]] constexpr int tspc(const channel_id& id) { return ((id.tracker * 10 + id.station) * 10 + id.plane) * 1000 + id.channel; }

/// Inverse of `tspc`.
[[nodiscard]] constexpr channel_id channel_from_tspc(int number) {
  return {number / 100000, number / 10000 % 10, number / 1000 % 10, number % 1000};
}

}  // namespace scifi
