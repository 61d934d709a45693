// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <scifi/core/units.hpp>
#include <scifi/field/coil.hpp>
#include <scifi/geometry/fibre.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/io/geometry_json.hpp>
#include <scifi/io/geometry_json_writer.hpp>
#include <scifi/io/json_field.hpp>
#include <scifi/io/line_reader.hpp>
#include <scifi/io/mice_geometry.hpp>

namespace scifi {

/// A geometry from a file of either kind, and what goes with it.
struct any_geometry {
  scifi::detector detector;
  fibre_doublet fibre;
  std::vector<std::optional<double>> field;  ///< of each tracker, along z of its frame, in `units::tesla`, where the file says
  std::vector<std::vector<coil>> coils;      ///< around each tracker, in its frame, where the file has coils
  std::vector<std::string> notes;            ///< what a user of the geometry should know of the file

  /// The one field that the file gives all trackers, or nothing. Throws std::invalid_argument when they have different ones.
  [[nodiscard]] std::optional<double> common_field() const {
    if (field.empty()) return std::nullopt;
    if (std::any_of(field.begin(), field.end(), [this](const auto& f) { return f != field.front(); }))
      throw std::invalid_argument("the geometry gives its trackers different fields: say with --field which to take");
    return field.front();
  }
};

/// True when the first mark in the file that is no blank is the brace of a JSON document. Throws input_error when it cannot be read.
[[nodiscard]] inline bool looks_like_json(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  if (name.ends_with(".json") || name.ends_with(".json.gz")) return true;
  if (name.ends_with(".dat") || name.ends_with(".dat.gz")) return false;
  line_reader lines(path);
  for (std::string_view line; lines.next(line);) {
    const std::size_t first = line.find_first_not_of(" \t");
    if (first != std::string_view::npos) return line[first] == '{' || line[first] == '[';
  }
  return true;
}

/// The geometry that a file describes, JSON or MiceModules: by its name (.json, .dat), else by its first mark. May be gzip.
/// In JSON the field of a tracker is its number `field`, tesla. Throws input_error with file, line or field, and the reason.
[[nodiscard]] inline any_geometry read_any_geometry(const std::filesystem::path& path) {
  any_geometry out;
  if (!looks_like_json(path)) {
    mice_geometry from = read_mice_geometry(path);
    return {std::move(from.detector), from.fibre, std::move(from.field), std::move(from.coils), std::move(from.notes)};
  }
  const nlohmann::json document = read_json(path);
  out.detector = geometry_from_json(document, path.string());
  out.fibre = fibre_from_json(document, path.string());
  const json_field trackers = json_field(document, path.string()).at("trackers");
  for (std::size_t i = 0; i < trackers.size(); ++i) {
    const json_field tracker = trackers.element(i);
    out.field.push_back(tracker.has("field") ? std::optional(tracker.at("field").number() * units::tesla) : std::nullopt);
  }
  return out;
}

/// The geometry as a JSON document that `read_any_geometry` reads back, field included; notes and coils are left out.
[[nodiscard]] inline nlohmann::ordered_json geometry_to_json(const any_geometry& g) {
  nlohmann::ordered_json out = geometry_to_json(g.detector, g.fibre);
  for (std::size_t i = 0; i < g.field.size() && i < g.detector.trackers.size(); ++i)
    if (g.field[i]) out["trackers"][i]["field"] = *g.field[i] / units::tesla;
  return out;
}

}  // namespace scifi
