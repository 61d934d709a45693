// SPDX-License-Identifier: MPL-2.0
#pragma once

/// Physical constants in native units (see units.hpp). Source: CODATA 2018 and PDG 2024, Review of Particle Physics, table 1.1 and 34.1.
namespace scifi::constants {

inline constexpr double pi = 3.14159265358979323846;
/// Speed of light, mm/ns, exact.
inline constexpr double speed_of_light = 299.792458;
/// Electron mass, MeV.
inline constexpr double electron_mass = 0.51099895;
/// K = 4 pi N_A r_e^2 m_e c^2, MeV cm2/mol (PDG 2024, table 34.1).
inline constexpr double bethe_k = 0.307075;

}  // namespace scifi::constants
