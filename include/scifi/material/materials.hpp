// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <limits>

#include <scifi/core/units.hpp>
#include <scifi/material/material.hpp>

/// Common media. Density, <Z/A>, radiation length and mean excitation energy: PDG 2024, Atomic and Nuclear Properties of Materials,
/// pdg.lbl.gov/AtomicNuclearProperties; a radiation length there is in g/cm2, here divided by the density.
/// Density effect: Sternheimer, Berger, Seltzer, At. Data Nucl. Data Tables 30 (1984) 261, as printed on the PDG pages.
/// Gases at 20 C and 1 atm. Another density of the same medium: see `at_density`.
namespace scifi::materials {

namespace detail {

/// X0 in mm from X0 in g/cm2.
constexpr double in_mm(double radiation_length_g_per_cm2, double density) { return radiation_length_g_per_cm2 / density * units::cm; }

}  // namespace detail

inline constexpr material polystyrene{
    "polystyrene", 1.060, detail::in_mm(43.79, 1.060), 0.53768, 68.7 * units::eV, {0.16454, 3.2224, 0.1647, 2.5031, 3.2999, 0.0}};
inline constexpr material mylar{"mylar", 1.400, detail::in_mm(39.95, 1.400), 0.52037, 78.7 * units::eV, {0.12679, 3.3076, 0.1562, 2.6507, 3.3262, 0.0}};
inline constexpr material helium{"helium", 1.663e-4,         detail::in_mm(94.32, 1.663e-4),
                                 0.49967,  41.8 * units::eV, {0.13443, 5.8347, 2.2017, 3.6122, 11.1393, 0.0}};
inline constexpr material aluminium{
    "aluminium", 2.699, detail::in_mm(24.01, 2.699), 0.48181, 166.0 * units::eV, {0.08024, 3.6345, 0.1708, 3.0127, 4.2395, 0.12}};
inline constexpr material liquid_hydrogen{"liquid hydrogen", 7.080e-2,         detail::in_mm(63.04, 7.080e-2),
                                          0.99212,           21.8 * units::eV, {0.13483, 5.6249, 0.4400, 1.8856, 3.0977, 0.0}};
inline constexpr material lithium_hydride{
    "lithium hydride", 0.820, detail::in_mm(79.62, 0.820), 0.50321, 36.5 * units::eV, {0.90567, 2.5849, -0.0988, 1.4515, 2.3580, 0.0}};
inline constexpr material air{"air", 1.205e-3, detail::in_mm(36.62, 1.205e-3), 0.49919, 85.7 * units::eV, {0.10914, 3.3994, 1.7418, 4.2759, 10.5961, 0.0}};
/// Neither scatters nor slows; the excitation energy stands under a logarithm that is multiplied by zero, any positive number does.
inline constexpr material vacuum{"vacuum", 0.0, std::numeric_limits<double>::infinity(), 0.0, 1.0 * units::eV, {0.0, 3.0, 2.0, 4.0, 10.0, 0.0}};

/// The same medium at another density (g/cm3): the radiation length scales, the density-effect parameters stay,
/// good for the few per cent between samples of a solid or liquid and not for a gas at another pressure.
[[nodiscard]] constexpr material at_density(material medium, double density) {
  medium.radiation_length *= medium.density / density;
  medium.density = density;
  return medium;
}

}  // namespace scifi::materials
