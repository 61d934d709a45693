// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <scifi/io/csv.hpp>

namespace scifi {

/// A table whose rows belong to events: the rows of an event stand together and event numbers grow, so that tables of the same events can be read
/// side by side, one event of each in memory. The column `event` is found by name and comes before the wanted ones: those count from 1.
class event_rows {
 public:
  /// Throws input_error as csv_reader does.
  event_rows(const std::filesystem::path& path, std::vector<std::string> wanted) : rows_(path, with_event(std::move(wanted))) { advance(); }

  static constexpr long no_more = std::numeric_limits<long>::max();

  /// Number of the event of the row that is next, or `no_more`.
  [[nodiscard]] long next_event() const { return next_; }

  /// Calls visit(rows) at each row of event `number`; none when the next event is a later one. Throws input_error where the table is out of order.
  template <class Visit>
  void read(long number, const Visit& visit) {
    while (next_ == number) {
      visit(std::as_const(rows_));
      advance();
    }
  }

  [[nodiscard]] const csv_reader& rows() const { return rows_; }

 private:
  [[nodiscard]] static std::vector<std::string> with_event(std::vector<std::string> wanted) {
    wanted.insert(wanted.begin(), "event");
    return wanted;
  }

  void advance() {
    const long last = next_;
    if (!rows_.next_row()) {
      next_ = no_more;
      return;
    }
    next_ = rows_.whole_number<long>(0);
    if (next_ == no_more) rows_.fail("event", std::to_string(next_) + " is too large for an event number");
    if (next_ < 0) rows_.fail("event", "event numbers must not be negative");
    if (next_ < last)
      rows_.fail("event", std::to_string(next_) + " comes after " + std::to_string(last) + ": the rows of an event must stand together and event numbers must grow");
  }

  csv_reader rows_;
  long next_ = -1;
};

}  // namespace scifi
