// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <scifi/io/csv.hpp>
#include <scifi/readout_to_digit/readout.hpp>

namespace scifi {

/// Events from a table of raw counts, one row a read-out channel, plain or gzip: a header line, then the columns event, board, bank (of the
/// board), channel and adc, found by name; others are ignored. The rows of an event stand together and the event numbers grow, so that one
/// event is in memory at a time. Throws input_error, with file, line and column, for whatever does not fit.
class raw_reader {
 public:
  explicit raw_reader(const std::filesystem::path& path, const readout_layout& layout = {})
      : rows_(path, {"event", "board", "bank", "channel", "adc"}), layout_(layout), seen_(layout.size(), never) {
    more_ = rows_.next_row();
    if (more_) next_number_ = rows_.whole_number<long>(event_column);
  }

  /// Puts the next event into `out`, which is emptied first, in the order of the file. False at the end.
  [[nodiscard]] bool read(raw_event& out) {
    out.counts.clear();
    if (!more_) return false;
    out.number = next_number_;
    event_start_ = rows_.line();
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
  enum columns : std::size_t { event_column, board_column, bank_column, channel_column, adc_column };

  [[nodiscard]] int within(std::size_t column, int highest) const {
    const int value = rows_.whole_number<int>(column);
    if (value < 0 || value > highest) rows_.fail(rows_.column_name(column), std::to_string(value) + " is outside 0 .. " + std::to_string(highest));
    return value;
  }

  void add_row(raw_event& out) {
    const readout_channel from{within(board_column, layout_.boards - 1), within(bank_column, layout_.banks - 1), within(channel_column, layout_.channels - 1)};
    const int adc = within(adc_column, layout_.largest_count);
    const std::optional<std::size_t> at = layout_.index(from);
    if (!at) rows_.fail("channel", "the read-out has no such channel");
    if (seen_[*at] >= event_start_) rows_.fail("channel", "a second count of this channel in the event, the first is in line " + std::to_string(seen_[*at]));
    seen_[*at] = rows_.line();
    out.counts.push_back({from, adc});
  }

  static constexpr long never = -1;
  csv_reader rows_;
  readout_layout layout_;
  std::vector<long> seen_;  // line of the channel's last count
  long event_start_ = 0, next_number_ = 0;
  bool more_ = false;
};

}  // namespace scifi
