// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <scifi/io/csv.hpp>
#include <scifi/io/event_rows.hpp>
#include <scifi/readout_to_digit/readout.hpp>

namespace scifi {

/// Events from a table of raw counts, one row a read-out channel, plain or gzip: a header line, then the columns event, board, bank (of the
/// board), channel and adc, found by name; others are ignored. The rows of an event stand together and the event numbers grow, so that one
/// event is in memory at a time. Throws input_error, with file, line and column, for whatever does not fit.
class raw_reader {
 public:
  explicit raw_reader(const std::filesystem::path& path, const readout_layout& layout = {})
      : rows_(path, {"board", "bank", "channel", "adc"}), layout_(layout), seen_(layout.size(), never) {}

  /// Puts the next event into `out`, which is emptied first, in the order of the file. False at the end.
  [[nodiscard]] bool read(raw_event& out) {
    out.counts.clear();
    if (rows_.next_event() == event_rows::no_more) return false;
    out.number = rows_.next_event();
    const long event_start = rows_.rows().line();
    rows_.read(out.number, [&](const csv_reader& row) { add_row(row, event_start, out); });
    return true;
  }

  /// The file behind it, for a progress display.
  [[nodiscard]] const text_source& source() const { return rows_.rows().source(); }

 private:
  [[nodiscard]] static int within(const csv_reader& row, std::size_t column, int highest) {
    const int value = row.whole_number<int>(column);
    if (value < 0 || value > highest) row.fail(row.column_name(column), std::to_string(value) + " is outside 0 .. " + std::to_string(highest));
    return value;
  }

  void add_row(const csv_reader& row, long event_start, raw_event& out) {
    enum columns : std::size_t { event_column, board, bank, channel, adc };
    const readout_channel from{within(row, board, layout_.boards - 1), within(row, bank, layout_.banks - 1), within(row, channel, layout_.channels - 1)};
    const int count = within(row, adc, layout_.largest_count);
    const std::optional<std::size_t> at = layout_.index(from);
    if (!at) row.fail("channel", "the read-out has no such channel");
    if (seen_[*at] >= event_start) row.fail("channel", "a second count of this channel in the event, the first is in line " + std::to_string(seen_[*at]));
    seen_[*at] = row.line();
    out.counts.push_back({from, count});
  }

  static constexpr long never = -1;
  event_rows rows_;
  readout_layout layout_;
  std::vector<long> seen_;  // line of the channel's last count
};

}  // namespace scifi
