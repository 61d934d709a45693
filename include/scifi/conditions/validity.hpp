// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include <scifi/io/input_error.hpp>

namespace scifi {

/// Number of a run of data taking, from 0 on.
using run_number = std::int64_t;

/// Last run of an interval that has no end yet.
inline constexpr run_number open_end = std::numeric_limits<run_number>::max();

/// The runs for which something is valid, both ends included.
struct run_interval {
  run_number first = 0;
  run_number last = open_end;

  [[nodiscard]] constexpr bool contains(run_number run) const { return first <= run && run <= last; }
  [[nodiscard]] constexpr bool is_valid() const { return 0 <= first && first <= last; }
  friend constexpr bool operator==(const run_interval&, const run_interval&) = default;
};

/// `7000:7999`, `7000:` (no end yet), `7000` (one run).
[[nodiscard]] inline std::string to_text(const run_interval& runs) {
  if (runs.last == open_end) return std::to_string(runs.first) + ':';
  if (runs.last == runs.first) return std::to_string(runs.first);
  return std::to_string(runs.first) + ':' + std::to_string(runs.last);
}

/// The run that a text of digits names. Throws std::invalid_argument with the reason.
[[nodiscard]] inline run_number run_number_from(std::string_view text) {
  run_number run = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), run);
  if (error == std::errc::result_out_of_range || (error == std::errc{} && run == open_end)) throw std::invalid_argument(in_quotes(text) + " is too large for a run");
  if (error != std::errc{} || end != text.data() + text.size() || run < 0) throw std::invalid_argument(in_quotes(text) + " is not the number of a run");
  return run;
}

/// The runs that `7000:7999`, `7000:` or `7000` names. Throws std::invalid_argument with the reason.
[[nodiscard]] inline run_interval run_interval_from(std::string_view text) {
  const std::size_t colon = text.find(':');
  run_interval runs;
  runs.first = run_number_from(text.substr(0, colon));
  if (colon == std::string_view::npos)
    runs.last = runs.first;
  else if (colon + 1 < text.size())
    runs.last = run_number_from(text.substr(colon + 1));
  if (!runs.is_valid()) throw std::invalid_argument(in_quotes(text) + " ends before it begins");
  return runs;
}

}  // namespace scifi
