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
#include <scifi/io/event_rows.hpp>

namespace scifi {

/// Events from a table of digits, one row a digit, plain or gzip: a header line, then the columns event, tracker, station, plane, channel
/// and npe, found by name; others are ignored. The digits of an event stand together and the event numbers grow, so that one event
/// is in memory at a time and no event can come back. Throws input_error, with file, line and column, for whatever does not fit.
class digit_reader {
 public:
  digit_reader(const std::filesystem::path& path, const detector& d) : rows_(path, {"tracker", "station", "plane", "channel", "npe"}), check_(d, "line") {}

  /// Puts number and digits of the next event into `out`, which is emptied first, in the order of the file. False at the end.
  [[nodiscard]] bool read(event& out) {
    enum columns : std::size_t { event_column, tracker, station, plane, channel, npe };
    out.clear();
    if (rows_.next_event() == event_rows::no_more) return false;
    out.number = rows_.next_event();
    check_.start_event(rows_.rows().line());
    rows_.read(out.number, [&](const csv_reader& row) {
      const digit d{{row.whole_number<int>(tracker), row.whole_number<int>(station), row.whole_number<int>(plane), row.whole_number<int>(channel)}, row.number(npe)};
      if (const auto fault = check_.fault_of(d, row.line())) row.fail(fault->field, fault->reason);
      out.digits.push_back(d);
    });
    return true;
  }

  /// The file behind it, for a progress display.
  [[nodiscard]] const text_source& source() const { return rows_.rows().source(); }

 private:
  event_rows rows_;
  digit_check check_;
};

}  // namespace scifi
