// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <iterator>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include <scifi/geometry/tracker.hpp>
#include <scifi/io/whole_number_rows.hpp>
#include <scifi/readout_to_digit/cabling_map.hpp>

namespace scifi {

namespace detail {

[[nodiscard]] inline std::string plane_in_words(const channel_id& id) {
  return "tracker " + std::to_string(id.tracker) + " station " + std::to_string(id.station) + " plane " + std::to_string(id.plane);
}

/// Reads a cabling file line by line; remembers where each connection was made.
class cabling_parser {
 public:
  cabling_parser(const std::filesystem::path& path, const detector& d, const readout_layout& layout)
      : rows_(path, {"board", "bank", "chan_ro", "tracker", "station", "plane", "channel", "extWG", "inWG", "WGfib"}), detector_(d), map_(layout) {}

  [[nodiscard]] cabling_map read() {
    while (rows_.next()) add_row();
    if (map_.cables().empty()) throw input_error(rows_.name(), 0, "", "connects no channel");
    check_planes();
    return std::move(map_);
  }

 private:
  enum columns : std::size_t { board_column, bank_column, readout_column, tracker_column, station_column, plane_column, channel_column };

  void add_row() {
    const readout_layout& layout = map_.layout();
    const readout_channel cable{rows_.within(board_column, 0, layout.boards - 1), rows_.within(bank_column, 0, layout.banks - 1),
                                rows_.within(readout_column, 0, layout.channels - 1)};
    const channel_id id{rows_[tracker_column], rows_[station_column], rows_[plane_column], rows_[channel_column]};
    const plane* p = detector_.find_plane(id);
    if (p == nullptr) rows_.fail("plane", "the geometry has no " + plane_in_words(id));
    if (!p->has_channel(id.channel))
      rows_.fail("channel", std::to_string(id.channel) + " is outside 0 .. " + std::to_string(p->channels - 1) + " of " + plane_in_words(id) +
                                " in the geometry: is it the one of this cabling?");
    const cabling_result result = map_.connect(cable, id);
    if (result == cabling_result::cable_taken)
      rows_.fail("chan_ro", "board " + std::to_string(cable.board) + " bank " + std::to_string(cable.bank) + " channel " + std::to_string(cable.channel) +
                                " is connected in line " + std::to_string(line_of_.at(*map_.channel_of(cable))) + " to another channel");
    if (result == cabling_result::channel_taken)
      rows_.fail("channel", plane_in_words(id) + " channel " + std::to_string(id.channel) + " has another cable in line " + std::to_string(line_of_.at(id)));
    line_of_.emplace(id, rows_.line());
  }

  /// A plane that is cabled up to another channel than its last one has been given the channels, and with them the position, of another plane.
  void check_planes() const {
    const auto& cables = map_.cables();
    for (auto at = cables.begin(); at != cables.end(); ++at) {
      const channel_id& id = at->first;
      const auto after = std::next(at);
      if (after != cables.end() && std::tie(after->first.tracker, after->first.station, after->first.plane) == std::tie(id.tracker, id.station, id.plane))
        continue;
      const int channels = detector_.find_plane(id)->channels;
      if (id.channel != channels - 1)
        throw input_error(rows_.name(), line_of_.at(id), "channel", plane_in_words(id) + " is cabled up to channel " + std::to_string(id.channel) + " but has " +
                          std::to_string(channels) + " channels in the geometry: is it the one of this cabling?");
    }
  }

  whole_number_rows rows_;
  const detector& detector_;
  cabling_map map_;
  std::map<channel_id, long> line_of_;
};

}  // namespace detail

/// The cabling that a text file (plain or gzip) describes, ten whole numbers a line as in the files of MICE: board, bank of the board, read-out
/// channel of the bank, tracker, station, plane, channel, and three that describe the wave guides and are not used. A line may be repeated.
/// How many channels a plane has is for the geometry to say: cabling files of different times disagree about it, and a channel outside a plane,
/// or a plane whose last channel has no cable, is an error. Throws input_error with file, line, column and reason.
[[nodiscard]] inline cabling_map read_cabling(const std::filesystem::path& path, const detector& d, const readout_layout& layout = {}) {
  return detail::cabling_parser(path, d, layout).read();
}

}  // namespace scifi
