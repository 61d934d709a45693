// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <scifi/conditions/recorded_time.hpp>
#include <scifi/conditions/validity.hpp>

namespace scifi {

/// What a document of the conditions describes.
enum class condition_kind { geometry, calibration, cabling, bad_channels, alignment };

inline constexpr std::array<condition_kind, 5> condition_kinds{condition_kind::geometry, condition_kind::calibration, condition_kind::cabling,
                                                               condition_kind::bad_channels, condition_kind::alignment};

[[nodiscard]] constexpr std::string_view name_of(condition_kind kind) {
  switch (kind) {
    case condition_kind::geometry: return "geometry";
    case condition_kind::calibration: return "calibration";
    case condition_kind::cabling: return "cabling";
    case condition_kind::bad_channels: return "bad_channels";
    case condition_kind::alignment: return "alignment";
  }
  return "unknown";
}

/// The kind of this name, or nothing.
[[nodiscard]] constexpr std::optional<condition_kind> condition_kind_from_name(std::string_view name) {
  for (const condition_kind kind : condition_kinds)
    if (name == name_of(kind)) return kind;
  return std::nullopt;
}

/// A document as it is handed in: for one tracker or (`tracker` empty) for all. `recorded` is given for what was recorded elsewhere before;
/// empty means now.
struct new_condition {
  condition_kind kind = condition_kind::geometry;
  std::optional<int> tracker;
  run_interval runs;
  std::optional<recorded_time> recorded;
  std::string source, comment, document;
};

/// A record of the store without its document. `recorded` is the time that a look-up goes by, `written` that at which the record came into
/// this store: later than `recorded` for what was dated back.
struct condition {
  std::int64_t id = 0;
  condition_kind kind = condition_kind::geometry;
  std::optional<int> tracker;
  run_interval runs;
  recorded_time recorded, written;
  std::string source, comment, sha256;
  std::size_t length = 0;
};

/// What is looked up: the condition for a run as it was known at a time (now, when empty), for one tracker or (empty) for all of them together.
struct condition_query {
  condition_kind kind = condition_kind::geometry;
  run_number run = 0;
  std::optional<recorded_time> as_of;
  std::optional<int> tracker;
};

}  // namespace scifi
