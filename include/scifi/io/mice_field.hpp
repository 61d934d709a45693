// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <scifi/core/linalg.hpp>
#include <scifi/core/units.hpp>
#include <scifi/field/coil.hpp>
#include <scifi/io/mice_module.hpp>
#include <scifi/io/mice_placed.hpp>

namespace scifi {

namespace detail {

inline void collect_coils(const placed_module& here, double scale, std::vector<coil>& out) {
  const mice_module& m = *here.module;
  const double scaled = scale * m.scale_factor;
  if (m.has("FieldType", "Solenoid")) {
    // The experiment's native units, mm and A/mm2: the files write these without units.
    const auto native = [&m](const char* name) {
      const mice_property& p = m.at(name);
      return p.words.size() == 1 ? p.number() : p.quantities(mice_quantity::length, 1)[0];
    };
    coil found{here.origin,         here.here_to_top(vector<double, 3>::UnitZ()), native("Length"), native("InnerRadius"),
                   native("Thickness"), m.at("CurrentDensity").number() * scaled};
    if (!(found.length > 0.0 && found.inner_radius > 0.0 && found.thickness > 0.0)) m.fail("its Length, InnerRadius and Thickness are not above zero");
    out.push_back(found);
  }
  for (const mice_module& child : m.children) collect_coils(here.inside(child), scaled, out);
}

/// Property MagneticField of the innermost module around (or at) `where`, along z of `where`, in `units::tesla`; nothing without one.
[[nodiscard]] inline std::optional<double> declared_field(const placed_module& where) {
  placed_module here(where.around.empty() ? *where.module : *where.around.front());
  std::optional<vector<double, 3>> in_top;
  const auto look = [&] {
    if (const mice_property* const p = here.module->find("MagneticField")) {
      const std::vector<double> b = p->quantities(mice_quantity::field, 3);
      in_top = here.here_to_top(vector<double, 3>(b[0], b[1], b[2]));
    }
  };
  look();
  for (std::size_t i = 1; i <= where.around.size(); ++i) {
    here = here.inside(i < where.around.size() ? *where.around[i] : *where.module);
    look();
  }
  if (!in_top) return std::nullopt;
  return rounded((where.top_to_here * *in_top).z() / units::tesla) * units::tesla;
}

/// Mean over the axis of `where` from z_first to z_last (its own frame, mm) of the field along it, in `units::tesla`.
/// Coils whose axis is not that of the tracker are taken at their distance along it: good for the coaxial channel of the experiment.
[[nodiscard]] inline double mean_field_on_axis(const std::vector<coil>& coils, const placed_module& where, double z_first, double z_last) {
  constexpr int steps = 1000;
  const vector<double, 3> axis = where.here_to_top(vector<double, 3>::UnitZ());
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const vector<double, 3> point = where.origin + axis * (z_first + (z_last - z_first) * (i + 0.5) / steps);
    for (const coil& c : coils) sum += axis.dot(c.axis) * field_on_axis(c, c.axis.dot(point - c.centre));
  }
  return sum / steps;
}

/// Coils of the outermost module in a frame with the axes of `where` about `origin`, a point of `where`.
[[nodiscard]] inline std::vector<coil> coils_seen_from(std::vector<coil> coils, const placed_module& where, const vector<double, 3>& origin) {
  for (coil& c : coils) {
    c.centre = rounded(vector<double, 3>(where.top_to_here * (c.centre - where.origin) - origin));
    c.axis = where.top_to_here * c.axis;
  }
  return coils;
}

[[nodiscard]] inline std::string in_tesla(double field) {
  char text[32];
  std::snprintf(text, sizeof text, "%+.2f T", field / units::tesla);
  return text;
}

}  // namespace detail

/// All coils (modules with FieldType Solenoid) of a tree, with their current densities times the ScaleFactors around them.
/// Throws input_error for a coil whose description is not complete.
[[nodiscard]] inline std::vector<coil> mice_coils(const mice_module& top) {
  std::vector<coil> out;
  detail::collect_coils(detail::placed_module(top), 1.0, out);
  return out;
}

}  // namespace scifi
