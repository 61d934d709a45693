// SPDX-License-Identifier: MPL-2.0
#pragma once

/// The library's units, on one page.
///
/// Native: millimetre, nanosecond, MeV (energy), MeV/c (momentum), elementary charge, radian. A number without a unit is in these.
/// The field is measured in (MeV/c)/(e mm), so that pt = q B R holds without a factor; `units::tesla` converts, 3 T = 3 * units::tesla.
/// Densities of materials are in g/cm3 and radiation lengths in mm, as tables give them; the functions that use them say so.
namespace scifi::units {

inline constexpr double mm = 1.0;
inline constexpr double um = 1.0e-3;
inline constexpr double cm = 10.0;
inline constexpr double m = 1000.0;
inline constexpr double ns = 1.0;
inline constexpr double us = 1000.0;
inline constexpr double MeV = 1.0;
inline constexpr double keV = 1.0e-3;
inline constexpr double eV = 1.0e-6;
inline constexpr double GeV = 1000.0;
inline constexpr double rad = 1.0;
inline constexpr double mrad = 1.0e-3;
inline constexpr double degree = 3.14159265358979323846 / 180.0;
/// 1 T = 0.299792458 (MeV/c)/(e mm): the speed of light in m/ns, exact since 1983.
inline constexpr double tesla = 0.299792458;

}  // namespace scifi::units

namespace scifi::literals {

constexpr double operator""_mm(long double v) { return static_cast<double>(v) * units::mm; }
constexpr double operator""_um(long double v) { return static_cast<double>(v) * units::um; }
constexpr double operator""_cm(long double v) { return static_cast<double>(v) * units::cm; }
constexpr double operator""_m(long double v) { return static_cast<double>(v) * units::m; }
constexpr double operator""_MeV(long double v) { return static_cast<double>(v) * units::MeV; }
constexpr double operator""_T(long double v) { return static_cast<double>(v) * units::tesla; }
constexpr double operator""_mrad(long double v) { return static_cast<double>(v) * units::mrad; }
constexpr double operator""_deg(long double v) { return static_cast<double>(v) * units::degree; }

}  // namespace scifi::literals
