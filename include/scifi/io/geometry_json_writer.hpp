// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <scifi/core/units.hpp>
#include <scifi/geometry/fibre.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/io/atomic_file.hpp>
#include <scifi/io/geometry_json.hpp>

namespace scifi {

namespace detail {

/// Gathers the media of a detector under names that differ.
class material_names {
 public:
  [[nodiscard]] std::string name_of(const material& m) {
    for (const auto& [name, known] : media_)
      if (known == m) return name;
    std::string name(m.name);
    for (int n = 2; name.empty() || taken(name); ++n) name = std::string(m.name) + " (" + std::to_string(n) + ')';
    media_.emplace_back(name, m);
    return name;
  }

  [[nodiscard]] nlohmann::ordered_json to_json() const {
    nlohmann::ordered_json out = nlohmann::ordered_json::object();
    for (const auto& [name, m] : media_) {
      const auto& d = m.density_effect;
      nlohmann::ordered_json& at = out[name];
      at["density_g_cm3"] = m.density;
      at["radiation_length"] = std::isfinite(m.radiation_length) ? nlohmann::ordered_json(m.radiation_length) : nlohmann::ordered_json(nullptr);
      at["z_over_a"] = m.z_over_a;
      at["mean_excitation_energy_eV"] = m.mean_excitation_energy / units::eV;
      at["density_effect"] = {{"a", d.a}, {"m", d.m}, {"x0", d.x0}, {"x1", d.x1}, {"c", d.c}, {"delta0", d.delta0}};
    }
    return out;
  }

 private:
  [[nodiscard]] bool taken(const std::string& name) const {
    for (const auto& [other, medium] : media_)
      if (other == name) return true;
    return false;
  }

  std::vector<std::pair<std::string, material>> media_;
};

[[nodiscard]] inline nlohmann::ordered_json stack_to_json(const slab_stack<4>& stack, material_names& media) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const slab& s : stack)
    out.push_back({{"material", media.name_of(s.medium)}, {"thickness", s.thickness}, {"layer_radiation_lengths", s.layer_radiation_lengths}});
  return out;
}

[[nodiscard]] inline nlohmann::ordered_json planes_to_json(const std::vector<plane>& planes, material_names& media) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const plane& p = planes[i];
    out.push_back({{"plane", i},
                   {"view", p.view},
                   {"angle", p.angle / units::degree},
                   {"channels", p.channels},
                   {"central_channel", p.central_channel},
                   {"channel_width", p.channel_width},
                   {"z_reference", p.z_reference},
                   {"z_measured", p.z_measured},
                   {"below", stack_to_json(p.below, media)},
                   {"above", stack_to_json(p.above, media)}});
  }
  return out;
}

}  // namespace detail

/// A detector as a geometry document, format `scifi-geometry` version 1, which geometry_from_json reads back to rounding. Planes that all
/// stations share are written once. `fibre` describes the fibres to other programs; the planes do not depend on it.
[[nodiscard]] inline nlohmann::ordered_json geometry_to_json(const detector& d, const fibre_doublet& fibre = {}) {
  detail::material_names media;
  nlohmann::ordered_json shared;
  nlohmann::ordered_json trackers = nlohmann::ordered_json::array();
  for (const tracker& t : d.trackers) {
    nlohmann::ordered_json stations = nlohmann::ordered_json::array();
    for (const station& s : t.stations) {
      const auto& o = s.in_tracker.origin;
      nlohmann::ordered_json at = {{"station", s.id}, {"position", {o.x(), o.y(), o.z()}}};
      if (s.in_tracker.angle != 0.0) at["rotation"] = s.in_tracker.angle / units::degree;
      nlohmann::ordered_json planes = detail::planes_to_json(s.planes, media);
      if (shared.is_null()) shared = planes;
      if (planes != shared) at["planes"] = std::move(planes);
      stations.push_back(std::move(at));
    }
    trackers.push_back({{"tracker", t.id},
                        {"name", t.name},
                        {"beam_direction", t.beam_direction},
                        {"fiducial_radius", t.fiducial_radius},
                        {"active_radius", t.active_radius},
                        {"gas", media.name_of(t.gas)},
                        {"stations", std::move(stations)}});
  }
  nlohmann::ordered_json out;
  out["format"] = geometry_format;
  out["version"] = geometry_version;
  out["units"] = {{"length", "mm"}, {"angle", "degree"}, {"field", "tesla"}};
  out["fibre"] = {{"diameter", fibre.diameter},
                  {"core_diameter", fibre.core_diameter},
                  {"pitch_in_layer", fibre.pitch},
                  {"fibres_per_channel", fibre.fibres_per_channel},
                  {"layer_separation", fibre.row_separation},
                  {"mylar_thickness", fibre.mylar_thickness}};
  out["materials"] = media.to_json();
  out["planes"] = std::move(shared);
  out["trackers"] = std::move(trackers);
  return out;
}

/// Writes a geometry file, complete or not at all. Throws input_error when it cannot be created, std::system_error when it cannot be written.
inline void write_geometry(const std::filesystem::path& path, const detector& d, const fibre_doublet& fibre = {}) {
  atomic_file file(path);
  file.write(geometry_to_json(d, fibre).dump(2) + '\n');
  file.commit();
}

}  // namespace scifi
