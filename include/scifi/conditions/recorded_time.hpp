// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <string_view>

#include <scifi/io/input_error.hpp>

namespace scifi {

/// The moment at which something was recorded: UTC, to the second.
using recorded_time = std::chrono::sys_seconds;

[[nodiscard]] inline recorded_time recorded_time_now() { return std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now()); }

/// Which moment a date without a time of day stands for. Asking what was known on a day means all that was recorded on it.
enum class date_alone { first_second, last_second };

namespace detail {

/// Takes fixed numbers of digits and single characters off the front of a text.
class date_scanner {
 public:
  explicit date_scanner(std::string_view text) : whole_(text), rest_(text) {}

  [[noreturn]] void fail(const std::string& why) const { throw std::invalid_argument(in_quotes(whole_) + " is not a date: " + why); }

  [[nodiscard]] int digits(std::size_t count, const char* name) {
    int value = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (i >= rest_.size() || rest_[i] < '0' || rest_[i] > '9') fail(std::string(name) + " is not " + std::to_string(count) + " digits");
      value = 10 * value + (rest_[i] - '0');
    }
    rest_.remove_prefix(count);
    return value;
  }
  [[nodiscard]] int digits_up_to(int highest, const char* name) {
    const int value = digits(2, name);
    if (value > highest) fail(std::string(name) + " " + std::to_string(value) + " is above " + std::to_string(highest));
    return value;
  }
  [[nodiscard]] bool take(char c) {
    if (!rest_.starts_with(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }
  [[nodiscard]] bool at_end() const { return rest_.empty(); }

 private:
  std::string_view whole_, rest_;
};

}  // namespace detail

/// The moment that an ISO 8601 date names: `2015-11-05`, `2015-11-05T14:30` or `2015-11-05T14:30:00`, each with or without `Z` after the time of
/// day, a space allowed for the `T`. Always UTC; another offset is refused. Throws std::invalid_argument with the reason.
[[nodiscard]] inline recorded_time recorded_time_from(std::string_view text, date_alone alone = date_alone::first_second) {
  using namespace std::chrono;
  detail::date_scanner scan(text);
  const char* const form = "it should read like 2015-11-05 or 2015-11-05T14:30:00Z";
  const int y = scan.digits(4, "the year");
  if (!scan.take('-')) scan.fail(form);
  const int m = scan.digits(2, "the month");
  if (!scan.take('-')) scan.fail(form);
  const int d = scan.digits(2, "the day");
  const year_month_day date{year(y), month(static_cast<unsigned>(m)), day(static_cast<unsigned>(d))};
  if (!date.ok()) scan.fail("the calendar has no such day");
  const recorded_time midnight = sys_days(date);
  if (scan.at_end()) return alone == date_alone::first_second ? midnight : midnight + days(1) - seconds(1);
  if (!scan.take('T') && !scan.take(' ')) scan.fail(form);
  const int hour = scan.digits_up_to(23, "the hour");
  if (!scan.take(':')) scan.fail(form);
  const int minute = scan.digits_up_to(59, "the minute");
  const int second = scan.take(':') ? scan.digits_up_to(59, "the second") : 0;
  const bool zulu = scan.take('Z');
  if (!zulu && (scan.take('+') || scan.take('-'))) scan.fail("give it in UTC, without an offset");
  if (!scan.at_end()) scan.fail(form);
  return midnight + hours(hour) + minutes(minute) + seconds(second);
}

/// `2015-11-05T14:30:00Z`, for years 0 to 9999.
[[nodiscard]] inline std::string to_text(recorded_time t) {
  using namespace std::chrono;
  const auto midnight = floor<days>(t);
  const year_month_day date(midnight);
  const hh_mm_ss<seconds> clock(t - midnight);
  std::array<char, 64> out{};
  const int n = std::snprintf(out.data(), out.size(), "%04d-%02u-%02uT%02d:%02d:%02dZ", static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                              static_cast<unsigned>(date.day()), static_cast<int>(clock.hours().count()), static_cast<int>(clock.minutes().count()),
                              static_cast<int>(clock.seconds().count()));
  return std::string(out.data(), static_cast<std::size_t>(n));
}

}  // namespace scifi
