// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include <scifi/event/event.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/io/csv.hpp>
#include <scifi/io/digit_check.hpp>

namespace scifi {

/// Events from a table of digits, one row a digit, plain or gzip: a header line, then the columns event, tracker, station, plane, channel
/// and npe, found by name; others are ignored. The digits of an event stand together and the event numbers grow, so that one event
/// is in memory at a time and no event can come back. Throws input_error, with file, line and column, for whatever does not fit.
class digit_reader {
 public:
  digit_reader(const std::filesystem::path& path, const detector& d)
      : rows_(path, {"event", "tracker", "station", "plane", "channel", "npe"}), check_(d, "line") {
    more_ = rows_.next_row();
    if (more_) next_number_ = rows_.whole_number<long>(event_column);
  }

  /// Puts number and digits of the next event into `out`, which is emptied first, in the order of the file. False at the end.
  [[nodiscard]] bool read(event& out) {
    out.clear();
    if (!more_) return false;
    out.number = next_number_;
    check_.start_event(rows_.line());
    do {
      add_row(out);
      more_ = rows_.next_row();
      if (more_) next_number_ = rows_.whole_number<long>(event_column);
    } while (more_ && next_number_ == out.number);
    if (more_ && next_number_ < out.number)
      rows_.fail("event", std::to_string(next_number_) + " comes after " + std::to_string(out.number) +
                              ": the rows of an event must stand together and event numbers must grow");
    return true;
  }

  /// The file behind it, for a progress display.
  [[nodiscard]] const text_source& source() const { return rows_.source(); }

 private:
  enum columns : std::size_t { event_column, tracker_column, station_column, plane_column, channel_column, npe_column };

  void add_row(event& out) {
    const digit d{{rows_.whole_number<int>(tracker_column), rows_.whole_number<int>(station_column), rows_.whole_number<int>(plane_column),
                   rows_.whole_number<int>(channel_column)},
                  rows_.number(npe_column)};
    if (const auto fault = check_.fault_of(d, rows_.line())) rows_.fail(fault->field, fault->reason);
    out.digits.push_back(d);
  }

  csv_reader rows_;
  digit_check check_;
  long next_number_ = 0;
  bool more_ = false;
};

}  // namespace scifi
