// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <scifi/geometry/tracker.hpp>
#include <scifi/io/csv.hpp>

namespace scifi {

/// The channels named in a table, one row a channel, plain or gzip: a header line, then the columns tracker, station, plane and channel, found by
/// name; others are ignored. A table of a header alone names none; a channel may be named again. Throws input_error, with file, line and column, for
/// whatever does not fit or is not in the detector.
[[nodiscard]] inline std::vector<channel_id> read_channel_list(const std::filesystem::path& path, const detector& d) {
  enum columns : std::size_t { tracker_column, station_column, plane_column, channel_column };
  csv_reader rows(path, {"tracker", "station", "plane", "channel"});
  std::vector<channel_id> out;
  while (rows.next_row()) {
    const channel_id id{rows.whole_number<int>(tracker_column), rows.whole_number<int>(station_column), rows.whole_number<int>(plane_column),
                        rows.whole_number<int>(channel_column)};
    const plane* p = d.find_plane(id);
    if (p == nullptr)
      rows.fail("plane", "there is no plane " + std::to_string(id.plane) + " in station " + std::to_string(id.station) + " of tracker " + std::to_string(id.tracker));
    if (!p->has_channel(id.channel)) rows.fail("channel", std::to_string(id.channel) + " is outside 0 .. " + std::to_string(p->channels - 1));
    out.push_back(id);
  }
  return out;
}

}  // namespace scifi
