// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include <scifi/event/event.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/io/digit_reader.hpp>
#include <scifi/io/mice_json.hpp>

/// Events from a file of either kind: MICE JSON where the name says .json (or .json.gz), else a table of digits.
class event_source {
 public:
  event_source(const std::filesystem::path& path, const scifi::detector& detector) {
    const std::string name = path.filename().string();
    if (name.ends_with(".json") || name.ends_with(".json.gz")) reader_.emplace<scifi::mice_json_reader>(path, detector);
    else reader_.emplace<scifi::digit_reader>(path, detector);
  }

  /// The next event; false at the end. Throws scifi::input_error.
  [[nodiscard]] bool read(scifi::event& out) {
    if (auto* json = std::get_if<scifi::mice_json_reader>(&reader_)) return json->read(out);
    return std::get<scifi::digit_reader>(reader_).read(out);
  }
  [[nodiscard]] const scifi::text_source& file() const {
    if (const auto* json = std::get_if<scifi::mice_json_reader>(&reader_)) return json->source();
    return std::get<scifi::digit_reader>(reader_).source();
  }

 private:
  std::variant<std::monostate, scifi::digit_reader, scifi::mice_json_reader> reader_;
};
