// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <scifi/core/linalg.hpp>
#include <scifi/core/units.hpp>
#include <scifi/io/mice_module.hpp>
#include <scifi/io/mice_placed.hpp>

namespace scifi {

/// A coil of rectangular cross-section in the frame of the outermost module.
struct mice_coil {
  vector<double, 3> centre;                                  ///< mm
  vector<double, 3> axis;                                    ///< of the turns, unit length: a positive current makes a field along it
  double length = 0.0, inner_radius = 0.0, thickness = 0.0;  ///< mm
  double current_density = 0.0;                              ///< A/mm2
};

/// Field of a coil on its axis, in `units::tesla`, at z (mm) from its middle:
///   B = mu0 J / 2 [u ln((R2 + sqrt(R2^2 + u^2)) / (R1 + sqrt(R1^2 + u^2)))] from u = z - L/2 to z + L/2,
/// Montgomery, Solenoid Magnet Design (1969), ch. 1. Valid at every z for R1 > 0.
[[nodiscard]] inline double field_on_axis(const mice_coil& coil, double z) {
  constexpr double mu0 = 4.0e-4 * std::numbers::pi;  // T mm / A
  const double inner = coil.inner_radius;
  const double outer = inner + coil.thickness;
  const auto primitive = [=](double u) { return u * std::log((outer + std::hypot(outer, u)) / (inner + std::hypot(inner, u))); };
  return 0.5 * mu0 * coil.current_density * (primitive(z + 0.5 * coil.length) - primitive(z - 0.5 * coil.length)) * units::tesla;
}

namespace detail {

inline void collect_coils(const placed_module& here, double scale, std::vector<mice_coil>& out) {
  const mice_module& m = *here.module;
  const double scaled = scale * m.scale_factor;
  if (m.has("FieldType", "Solenoid")) {
    // The experiment's native units, mm and A/mm2: the files write these without units.
    const auto native = [&m](const char* name) {
      const mice_property& p = m.at(name);
      return p.words.size() == 1 ? p.number() : p.quantities(mice_quantity::length, 1)[0];
    };
    mice_coil coil{here.origin,         here.here_to_top(vector<double, 3>::UnitZ()), native("Length"), native("InnerRadius"),
                   native("Thickness"), m.at("CurrentDensity").number() * scaled};
    if (!(coil.length > 0.0 && coil.inner_radius > 0.0 && coil.thickness > 0.0)) m.fail("its Length, InnerRadius and Thickness are not above zero");
    out.push_back(coil);
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
[[nodiscard]] inline double mean_field_on_axis(const std::vector<mice_coil>& coils, const placed_module& where, double z_first, double z_last) {
  constexpr int steps = 1000;
  const vector<double, 3> axis = where.here_to_top(vector<double, 3>::UnitZ());
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const vector<double, 3> point = where.origin + axis * (z_first + (z_last - z_first) * (i + 0.5) / steps);
    for (const mice_coil& c : coils) sum += axis.dot(c.axis) * field_on_axis(c, c.axis.dot(point - c.centre));
  }
  return sum / steps;
}

[[nodiscard]] inline std::string in_tesla(double field) {
  char text[32];
  std::snprintf(text, sizeof text, "%+.2f T", field / units::tesla);
  return text;
}

}  // namespace detail

/// All coils (modules with FieldType Solenoid) of a tree, with their current densities times the ScaleFactors around them.
/// Throws input_error for a coil whose description is not complete.
[[nodiscard]] inline std::vector<mice_coil> mice_coils(const mice_module& top) {
  std::vector<mice_coil> out;
  detail::collect_coils(detail::placed_module(top), 1.0, out);
  return out;
}

}  // namespace scifi
