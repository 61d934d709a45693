// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/core/constants.hpp>
#include <scifi/core/linalg.hpp>
#include <scifi/core/units.hpp>

namespace scifi {

/// A coil of rectangular cross-section with the same current density all over it.
struct coil {
  vector<double, 3> centre = vector<double, 3>::Zero();      ///< mm
  vector<double, 3> axis = vector<double, 3>::UnitZ();       ///< of the turns, unit length: a positive current makes a field along it
  double length = 0.0, inner_radius = 0.0, thickness = 0.0;  ///< mm, > 0
  double current_density = 0.0;                              ///< A/mm2
};

/// Magnetic constant in (MeV/c)/(e mm) times mm/A: 4 pi 1e-7 T m/A (CODATA 2018 differs by 6e-10 of it).
inline constexpr double magnetic_constant = 4.0e-4 * constants::pi * units::tesla;

/// Field of a coil on its axis, in (MeV/c)/(e mm), at z (mm) from its middle:
///   B = mu0 J / 2 [u ln((R2 + sqrt(R2^2 + u^2)) / (R1 + sqrt(R1^2 + u^2)))] from u = z - L/2 to z + L/2,
/// Montgomery, Solenoid Magnet Design (1969), ch. 1. Valid at every z.
[[nodiscard]] inline double field_on_axis(const coil& c, double z) {
  const double inner = c.inner_radius;
  const double outer = inner + c.thickness;
  const auto primitive = [=](double u) { return u * std::log((outer + std::hypot(outer, u)) / (inner + std::hypot(inner, u))); };
  return 0.5 * magnetic_constant * c.current_density * (primitive(z + 0.5 * c.length) - primitive(z - 0.5 * c.length));
}

}  // namespace scifi
