// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <scifi/core/units.hpp>
#include <scifi/event/candidate.hpp>
#include <scifi/event/space_point.hpp>
#include <scifi/field/coil.hpp>
#include <scifi/geometry/fibre.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/io/mice_field.hpp>
#include <scifi/io/mice_module.hpp>
#include <scifi/io/mice_module_reader.hpp>
#include <scifi/io/mice_placed.hpp>

namespace scifi {

/// What a MiceModules geometry says of its trackers, in order of their ids.
struct mice_geometry {
  scifi::detector detector;
  fibre_doublet fibre;
  /// Of each tracker, along z of its frame, in `units::tesla`: property MagneticField of the innermost module around it that has one.
  std::vector<std::optional<double>> field;
  /// The same from the coils of the file, if there are any: mean on the axis from the first station to the last.
  std::vector<std::optional<double>> coil_field;
  std::vector<std::vector<coil>> coils;  ///< of the file, in the frame of each tracker
  std::vector<std::string> notes;  ///< what a user of the geometry should know of the file
};

namespace detail {

/// Builds the trackers from the tree of modules.
class mice_geometry_builder {
 public:
  explicit mice_geometry_builder(const mice_module& top) : top_(top) {}

  [[nodiscard]] mice_geometry build() {
    look_for_trackers(placed_module(top_));
    if (found_.empty()) {
      if (first_missing_ != nullptr) first_missing_->fail("the file is not there, and no other module has the property Tracker");
      top_.fail("holds no module with the property Tracker");
    }
    std::sort(found_.begin(), found_.end(), [](const found_tracker& a, const found_tracker& b) { return a.result.id < b.result.id; });
    const std::vector<coil> coils = mice_coils(top_);
    for (found_tracker& f : found_) {
      if (!out_.detector.trackers.empty() && out_.detector.trackers.back().id == f.result.id)
        f.where.module->at("Tracker").fail("tracker " + std::to_string(f.result.id) + " is given twice");
      const std::optional<double> declared = declared_field(f.where);
      std::optional<double> from_coils;
      if (!coils.empty()) from_coils = mean_field_on_axis(coils, f.where, f.first_z, f.last_z);
      if (from_coils)
        note("tracker " + std::to_string(f.result.id) + ": field along z " + (declared ? in_tesla(*declared) + " by the property MagneticField, " : "") +
             in_tesla(*from_coils) + " in the mean from the " + std::to_string(coils.size()) + " coils of the file");
      out_.field.push_back(declared);
      out_.coil_field.push_back(from_coils);
      out_.coils.push_back(coils_seen_from(coils, f.where, f.origin));
      out_.detector.trackers.push_back(std::move(f.result));
    }
    return std::move(out_);
  }

 private:
  struct found_tracker {
    placed_module where;
    tracker result;
    double first_z, last_z;    // of the stations, frame of the tracker's module
    vector<double, 3> origin;  // of the tracker frame, in that of the module
  };

  void look_for_trackers(const placed_module& here) {
    if (here.module->find("Tracker") != nullptr) {
      found_.push_back(read_tracker(here));
      return;
    }
    const auto& inside = here.module->children;
    // Beside a tracker the experiment's files name its cryostat, windows and coils; anywhere else a module that is not there could hold a tracker.
    const bool beside_tracker = std::any_of(inside.begin(), inside.end(), [](const mice_module& m) { return m.find("Tracker") != nullptr; });
    for (const mice_module& child : inside) {
      if (child.missing) {
        if (first_missing_ == nullptr) first_missing_ = &child;
        if (!beside_tracker) child.fail("the file is not there");
        note(child.file + ':' + std::to_string(child.line) + ": " + child.name + " is not there; it is not part of a tracker");
      } else {
        look_for_trackers(here.inside(child));
      }
    }
  }

  [[nodiscard]] found_tracker read_tracker(const placed_module& where) {
    const mice_module& m = *where.module;
    constexpr int largest_id = 9;
    tracker t;
    t.id = m.at("Tracker").whole_number(0, largest_id);
    t.name = t.id == mice::upstream ? "TKU" : t.id == mice::downstream ? "TKD" : m.name;
    const double along_beam = where.top_to_here(2, 2);
    if (std::abs(along_beam) < 0.5) m.fail("its z axis does not lie along that of the geometry, the beam");
    t.beam_direction = along_beam > 0.0 ? 1 : -1;
    t.gas = medium_of(m);
    std::vector<placed_module> stations;
    look_for_stations(placed_module(m), stations);
    if (stations.empty()) m.fail("holds no station");
    if (stations.size() > max_stations) m.fail("holds more than " + std::to_string(max_stations) + " stations");
    std::sort(stations.begin(), stations.end(), [](const placed_module& a, const placed_module& b) { return a.origin.z() < b.origin.z(); });
    for (const placed_module& s : stations) t.stations.push_back(read_station(s, t));
    const vector<double, 3> origin = t.stations.front().in_tracker.origin;
    for (std::size_t i = 0; i < t.stations.size(); ++i) {
      t.stations[i].in_tracker.origin = rounded(t.stations[i].in_tracker.origin - origin);
      if (i == 0) continue;
      if (t.stations[i].id <= t.stations[i - 1].id) stations[i].module->at("Station").fail("station numbers do not grow with z of the tracker");
      const station& before = t.stations[i - 1];
      const double end = before.in_tracker.origin.z() + before.planes.back().z_measured + thickness(before.planes.back().above);
      if (t.stations[i].in_tracker.origin.z() < end) stations[i].module->fail("the station does not lie behind the one before it in z");
    }
    constexpr double quoted_radius = 150.0;  // mm, Ellis et al., NIM A 659 (2011) 136: the active diameter is 30 cm; the files do not hold it
    t.fiducial_radius = std::min(quoted_radius, t.active_radius);
    return {where, std::move(t), stations.front().origin.z(), stations.back().origin.z(), origin};
  }

  static void look_for_stations(const placed_module& here, std::vector<placed_module>& out) {
    for (const mice_module& child : here.module->children) {
      const placed_module placed = here.inside(child);
      if (child.missing) child.fail("the file is not there, and the module is part of a tracker");
      if (is_plane(child)) child.fail("a plane that is in no station");
      const bool has_planes = std::any_of(child.children.begin(), child.children.end(), is_plane);
      if (has_planes) out.push_back(placed);
      else look_for_stations(placed, out);
    }
  }
  [[nodiscard]] static bool is_plane(const mice_module& m) { return m.has("SensitiveDetector", "SciFi"); }

  [[nodiscard]] station read_station(const placed_module& where, tracker& t) {
    const mice_module& m = *where.module;
    constexpr int largest_id = 9;
    station s;
    s.id = m.at("Station").whole_number(1, largest_id);
    s.in_tracker = {where.origin, where.angle_about_z()};
    std::vector<placed_module> planes;
    std::vector<double> sheets;  // z, station module
    double sheet_thickness = 0.0;
    for (const mice_module& child : m.children) {
      if (child.missing) child.fail("the file is not there, and the module is part of a tracker");
      if (is_plane(child)) {
        planes.push_back(placed_module(m).inside(child));
      } else if (child.has("Material", "MYLAR")) {
        sheets.push_back(child.position.z());
        sheet_thickness = length_of(child);
      }
    }
    if (planes.size() > max_planes_per_station) m.fail("holds more than " + std::to_string(max_planes_per_station) + " planes");
    if (!sheets.empty() && sheets.size() != planes.size())
      m.fail("has " + std::to_string(sheets.size()) + " mylar sheets for " + std::to_string(planes.size()) + " planes");
    std::sort(planes.begin(), planes.end(), [](const placed_module& a, const placed_module& b) { return a.origin.z() < b.origin.z(); });
    std::sort(sheets.begin(), sheets.end());
    const auto surface = [&](const placed_module& p) { return p.origin.z() - 0.5 * length_of(*p.module) - sheet_thickness; };
    const double reference = surface(planes.front());
    for (std::size_t i = 0; i < planes.size(); ++i) {
      const mice_module& from = *planes[i].module;
      if (from.at("Plane").whole_number(0, max_planes_per_station - 1) != static_cast<int>(i))
        from.at("Plane").fail("is not " + std::to_string(i) + ": planes are numbered from 0 in order of growing z");
      s.planes.push_back(read_plane(planes[i], sheet_thickness, surface(planes[i]) - reference));
      constexpr double touching = 1.0e-6;  // mm
      const plane& p = s.planes.back();
      if (i > 0 && p.z_reference < s.planes[i - 1].z_measured + thickness(s.planes[i - 1].above) - touching)
        from.fail("with its mylar sheet it begins before the plane below it ends");
      if (!sheets.empty() && std::abs(sheets[i] - (reference + p.z_reference + 0.5 * sheet_thickness)) > touching && !moved_sheets_) {
        moved_sheets_ = true;
        note(m.file + ':' + std::to_string(m.line) + ": the mylar sheets of the stations overlap the fibres as written, with the gaps at the " +
             "mirrored positions; each is put before its plane, where the gap is");
      }
      const double radius = from.at("ActiveRadius").positive_length();
      t.active_radius = t.active_radius > 0.0 ? std::min(t.active_radius, radius) : radius;
    }
    as_one_layer(s);
    s.in_tracker.origin += where.here_to_top(vector<double, 3>(0.0, 0.0, reference));
    return s;
  }

  [[nodiscard]] plane read_plane(const placed_module& where, double sheet_thickness, double z) {
    const mice_module& m = *where.module;
    constexpr double touching = 1.0e-6;
    if (std::hypot(where.origin.x(), where.origin.y()) > touching) m.fail("the plane is shifted across its station; only stations may be");
    fibre_doublet f;
    f.pitch = m.at("Pitch").positive_length();
    f.diameter = m.at("FibreDiameter").positive_length();
    f.core_diameter = m.at("CoreDiameter").positive_length();
    f.mylar_thickness = sheet_thickness;
    if (f.core_diameter > f.diameter) m.at("CoreDiameter").fail("is larger than the diameter");
    if (f.pitch < f.diameter || f.pitch >= 2.0 * f.diameter) m.at("Pitch").fail("does not lie between one and two diameters: two rows do not nest");
    f.row_separation = std::sqrt(f.diameter * f.diameter - 0.25 * f.pitch * f.pitch);
    if (!fibre_known_) out_.fibre = f;
    fibre_known_ = true;
    if (f.pitch != out_.fibre.pitch || f.diameter != out_.fibre.diameter || f.core_diameter != out_.fibre.core_diameter)
      m.fail("its fibres differ from those of the planes before it");

    // CentralFibre is the central channel: the fibres, 2 (7 CentralFibre + 3.5), fill 2 CentralFibre + 1 channels of seven.
    const mice_property& central = m.at("CentralFibre");
    constexpr double most_channels = 1.0e4;  // a typing error, not a detector
    const double channels = 2.0 * central.number() + 1.0;
    if (channels != std::floor(channels) || channels < 1.0 || channels > most_channels)
      central.fail(in_quotes(central.words[0]) + " is not the middle of a whole number of channels");
    const material fibres = medium_of(m);
    const double half = 0.5 * length_of(m);
    plane p;
    p.view = view_of(m.name);
    p.angle = where.angle_about_z();
    p.channels = static_cast<int>(channels);
    p.central_channel = central.number();
    p.channel_width = f.channel_width();
    p.z_reference = rounded(z);
    p.z_measured = rounded(z + sheet_thickness + half);
    if (sheet_thickness > 0.0) p.below.add(whole(materials::mylar, sheet_thickness));
    p.below.add(whole(fibres, half));
    p.above.add(whole(fibres, half));
    return p;
  }

  void note(std::string text) {
    if (std::find(out_.notes.begin(), out_.notes.end(), text) == out_.notes.end()) out_.notes.push_back(std::move(text));
  }

  const mice_module& top_;
  mice_geometry out_;
  std::vector<found_tracker> found_;
  const mice_module* first_missing_ = nullptr;
  bool moved_sheets_ = false, fibre_known_ = false;
};

}  // namespace detail

/// The trackers of a tree of modules. A tracker is a module with the property Tracker; its frame is that of the module, moved to the reference
/// surface of its first station; the beam travels along z of the outermost module. Throws input_error with file, line, module or property.
[[nodiscard]] inline mice_geometry mice_geometry_from(const mice_module& top) { return detail::mice_geometry_builder(top).build(); }

/// The trackers that a MiceModules file describes. Throws input_error with file, line and reason.
[[nodiscard]] inline mice_geometry read_mice_geometry(const std::filesystem::path& path) { return mice_geometry_from(read_mice_modules(path)); }

}  // namespace scifi
