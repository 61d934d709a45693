// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <scifi/conditions/condition.hpp>
#include <scifi/io/calibration_json.hpp>
#include <scifi/io/geometry_json.hpp>
#include <scifi/io/input_error.hpp>
#include <scifi/io/json_field.hpp>

namespace scifi {

/// Tries a document of one kind with a reader. `reads` returns false for a format that is not its own, and throws input_error for one that is
/// and has a mistake; `file` is for messages.
struct document_check {
  condition_kind kind = condition_kind::geometry;
  std::function<bool(const std::string& document, const std::string& file)> reads;
};

/// The checks for which the library has readers.
[[nodiscard]] inline std::vector<document_check> built_in_document_checks() {
  const auto geometry = [](const std::string& document, const std::string& file) {
    const std::size_t first = document.find_first_not_of(" \t\r\n");
    const bool opens_an_object = first != std::string::npos && document[first] == '{';
    if (!opens_an_object && !file.ends_with(".json")) return false;
    const nlohmann::json parsed = parse_json(document, file);
    static_cast<void>(geometry_from_json(parsed, file));
    static_cast<void>(fibre_from_json(parsed, file));
    return true;
  };
  const auto calibration = [](const std::string& document, const std::string& file) {
    static_cast<void>(calibration_from_json(parse_json(document, file), file));
    return true;
  };
  return {{condition_kind::geometry, geometry}, {condition_kind::calibration, calibration}};
}

/// Whether a check knows the document and found it good; false when none knows its format. Throws input_error when one found a mistake
/// and for an empty document, unless it lists the bad channels, of which there may be none.
[[nodiscard]] inline bool check_document(const std::vector<document_check>& checks, condition_kind kind, const std::string& document, const std::string& file) {
  if (document.empty() && kind != condition_kind::bad_channels) throw input_error(file, 0, "", "the file is empty");
  for (const document_check& c : checks)
    if (c.kind == kind && c.reads(document, file)) return true;
  return false;
}

}  // namespace scifi
