// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include <scifi/core/units.hpp>
#include <scifi/event/candidate.hpp>
#include <scifi/event/space_point.hpp>
#include <scifi/geometry/fibre.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/io/json_field.hpp>
#include <scifi/io/material_json.hpp>

namespace scifi {

/// `format` and `version` of a geometry file as this library writes it. A file without them is taken as version 1.
inline constexpr std::string_view geometry_format = "scifi-geometry";
inline constexpr int geometry_version = 1;

namespace detail {

/// Reads the parts of a geometry document; holds what its planes share.
class geometry_parser {
 public:
  explicit geometry_parser(const json_field& root) : root_(root) {
    check_header();
    for (const char* name : {"polystyrene", "mylar", "helium"}) media_.emplace(name, *built_in_material(name));
    if (!root.has("materials")) return;
    const json_field materials = root.at("materials");
    if (!materials.value().is_object()) materials.fail("is not an object");
    for (const auto& member : materials.value().items())
      media_.insert_or_assign(member.key(), material_from_json(materials.at(member.key().c_str()), member.key()));
  }

  [[nodiscard]] detector read() const {
    detector d;
    const json_field trackers = root_.at("trackers");
    for (std::size_t i = 0; i < trackers.size(); ++i) {
      const json_field from = trackers.element(i);
      tracker t = read_tracker(from);
      if (d.find(t.id) != nullptr) from.at("tracker").fail("tracker " + std::to_string(t.id) + " is given twice");
      d.trackers.push_back(std::move(t));
    }
    if (d.trackers.empty()) trackers.fail("names no tracker");
    std::size_t channels = 0;
    for (const tracker& t : d.trackers)
      for (const station& s : t.stations)
        for (const plane& p : s.planes) channels += static_cast<std::size_t>(p.channels);
    if (channels > most_channels_in_all) trackers.fail("have " + std::to_string(channels) + " channels, more than " + std::to_string(most_channels_in_all));
    return d;
  }

 private:
  void check_header() const {
    if (!root_.value().is_object()) root_.fail("the document is not an object");
    if (root_.has("format") && root_.at("format").text() != geometry_format)
      root_.at("format").fail(in_quotes(root_.at("format").text()) + " is not '" + std::string(geometry_format) + "'");
    if (root_.has("version") && root_.at("version").whole_number(1) > geometry_version)
      root_.at("version").fail("version " + root_.at("version").value().dump() + " is newer than version " + std::to_string(geometry_version) +
                               ", the newest that can be read");
    if (!root_.has("units")) return;
    const json_field units = root_.at("units");
    for (const auto& [key, unit] : {std::pair{"length", "mm"}, std::pair{"angle", "degree"}})
      if (units.has(key) && units.at(key).text() != unit) units.at(key).fail(in_quotes(units.at(key).text()) + " is not '" + unit + "'");
  }

  [[nodiscard]] tracker read_tracker(const json_field& from) const {
    tracker t;
    t.id = from.at("tracker").whole_number(0);
    t.name = from.has("name") ? from.at("name").text() : "tracker " + std::to_string(t.id);
    t.beam_direction = from.at("beam_direction").whole_number(-1, 1);
    if (t.beam_direction == 0) from.at("beam_direction").fail("is neither 1 nor -1");
    t.fiducial_radius = (from.has("fiducial_radius") ? from : root_).at("fiducial_radius").positive();
    // As in MICE, where planes are active to 10 mm beyond the fiducial radius.
    t.active_radius = from.has("active_radius") ? from.at("active_radius").positive() : t.fiducial_radius + 10.0;
    t.gas = from.has("gas") ? medium(from.at("gas")) : media_.at("helium");
    const json_field stations = from.at("stations");
    if (stations.size() == 0) stations.fail("names no station");
    if (stations.size() > max_stations) stations.fail("more than " + std::to_string(max_stations) + " stations");
    for (std::size_t i = 0; i < stations.size(); ++i) {
      const json_field at = stations.element(i);
      station s = read_station(at);
      if (i > 0) {
        const station& before = t.stations.back();
        if (s.id <= before.id) at.at("station").fail("station numbers do not grow");
        const double end = before.in_tracker.origin.z() + before.planes.back().z_measured + thickness(before.planes.back().above);
        if (s.in_tracker.origin.z() + s.planes.front().z_reference < end) at.at("position").fail("the station does not lie behind the one before it in z");
      }
      t.stations.push_back(std::move(s));
    }
    return t;
  }

  [[nodiscard]] station read_station(const json_field& from) const {
    station s;
    s.id = from.at("station").whole_number(1);
    const json_field position = from.at("position");
    if (position.size() != 3) position.fail("is not three numbers");
    s.in_tracker.origin = {position.element(0).number(), position.element(1).number(), position.element(2).number()};
    if (from.has("rotation")) s.in_tracker.angle = from.at("rotation").number() * units::degree;
    const json_field planes = (from.has("planes") ? from : root_).at("planes");
    if (planes.size() == 0) planes.fail("names no plane");
    if (planes.size() > max_planes_per_station) planes.fail("more than " + std::to_string(max_planes_per_station) + " planes in a station");
    bool given_by_slabs = false;
    for (std::size_t i = 0; i < planes.size(); ++i) {
      const json_field at = planes.element(i);
      given_by_slabs |= at.has("z_measured");
      if (at.at("plane").whole_number() != static_cast<int>(i))
        at.at("plane").fail("is not " + std::to_string(i) + ": planes are numbered from 0 in order of growing z");
      s.planes.push_back(read_plane(at));
      if (i == 0) continue;
      const plane& before = s.planes[i - 1];
      if (s.planes[i].z_reference < before.z_measured + thickness(before.above) - rounding) at.fail("the plane begins before the one below it ends");
    }
    // Planes given by their sheets: the station is one layer. Planes given by slabs say their layers themselves.
    if (!given_by_slabs) as_one_layer(s);
    return s;
  }

  [[nodiscard]] plane read_plane(const json_field& from) const {
    plane p;
    p.view = from.has("view") ? from.at("view").text() : "";
    p.angle = from.at("angle").number() * units::degree;
    p.channels = from.at("channels").whole_number(1, most_channels);
    p.central_channel = from.at("central_channel").number();
    p.channel_width = (from.has("channel_width") ? from : root_).at("channel_width").positive();
    if (from.has("z_measured")) {
      p.z_reference = from.at("z_reference").number();
      p.z_measured = from.at("z_measured").number();
      p.below = read_stack(from.at("below"));
      p.above = read_stack(from.at("above"));
      if (std::abs(p.z_reference + thickness(p.below) - p.z_measured) > rounding)
        from.at("below").fail("its thicknesses do not reach from z_reference to z_measured");
      return p;
    }
    const auto [sheet_from, sheet_to] = interval(from.at("z_mylar"));
    const auto [fibres_from, fibres_to] = interval(from.at("z_fibres"));
    if (std::abs(fibres_from - sheet_to) > rounding) from.at("z_fibres").fail("the fibres do not begin where the mylar ends");
    const material& sheet = media_.at("mylar");
    const material& fibres = media_.at("polystyrene");
    const double half = 0.5 * (fibres_to - fibres_from);
    p.z_reference = sheet_from;
    p.z_measured = fibres_from + half;
    p.below.add(whole(sheet, sheet_to - sheet_from)).add(whole(fibres, half));
    p.above.add(whole(fibres, half));
    return p;
  }

  [[nodiscard]] slab_stack<4> read_stack(const json_field& from) const {
    slab_stack<4> stack;
    if (from.size() > stack.capacity()) from.fail("more than " + std::to_string(stack.capacity()) + " slabs");
    for (std::size_t i = 0; i < from.size(); ++i) {
      const json_field at = from.element(i);
      slab s = whole(medium(at.at("material")), at.at("thickness").positive());
      if (at.has("layer_radiation_lengths")) s.layer_radiation_lengths = at.at("layer_radiation_lengths").number();
      stack.add(s);
    }
    return stack;
  }

  [[nodiscard]] const material& medium(const json_field& name) const {
    const auto found = media_.find(name.text());
    if (found == media_.end()) name.fail(in_quotes(name.text()) + " is not among the materials of the file");
    return found->second;
  }
  [[nodiscard]] static std::pair<double, double> interval(const json_field& from) {
    if (from.size() != 2) from.fail("is not two numbers");
    const std::pair<double, double> out{from.element(0).number(), from.element(1).number()};
    if (!(out.first < out.second)) from.fail("does not grow");
    return out;
  }

  static constexpr double rounding = 1.0e-6;       // mm
  static constexpr int most_channels = 1'000'000;  // a typing error, not a detector
  static constexpr std::size_t most_channels_in_all = 10'000'000;  // each takes memory
  json_field root_;
  std::map<std::string, material, std::less<>> media_;
};

}  // namespace detail

/// The detector that a geometry document describes (docs: format `scifi-geometry`, version 1). Lengths in mm, angles in degrees, positions in
/// the tracker frame, z of planes in the station frame. A fibre plane is `z_mylar` and `z_fibres`; another plane gives `z_reference`,
/// `z_measured`, `below` and `above`. Unknown fields are ignored. `file` is for messages. Throws input_error with the field and the reason.
[[nodiscard]] inline detector geometry_from_json(const nlohmann::json& document, const std::string& file) {
  return detail::geometry_parser(json_field(document, file)).read();
}

/// The detector that a geometry file (plain or gzip) describes. Throws input_error with file, line or field, and the reason.
[[nodiscard]] inline detector read_geometry(const std::filesystem::path& path) { return geometry_from_json(read_json(path), path.string()); }

/// The fibres that a geometry document describes in `fibre`; what it leaves out is as in MICE. Throws input_error.
[[nodiscard]] inline fibre_doublet fibre_from_json(const nlohmann::json& document, const std::string& file) {
  fibre_doublet f;
  const json_field root(document, file);
  if (!root.has("fibre")) return f;
  const json_field from = root.at("fibre");
  const auto take = [&](const char* key, double& value) {
    if (from.has(key)) value = from.at(key).positive();
  };
  take("diameter", f.diameter);
  take("core_diameter", f.core_diameter);
  take("pitch_in_layer", f.pitch);
  take("layer_separation", f.row_separation);
  if (from.has("mylar_thickness")) f.mylar_thickness = from.at("mylar_thickness").number();
  if (f.mylar_thickness < 0.0) from.at("mylar_thickness").fail("is negative");
  if (from.has("fibres_per_channel")) f.fibres_per_channel = from.at("fibres_per_channel").whole_number(1);
  if (f.core_diameter > f.diameter) from.at("core_diameter").fail("is larger than the diameter");
  return f;
}

}  // namespace scifi
