// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include <scifi/core/units.hpp>
#include <scifi/io/json_field.hpp>
#include <scifi/material/material.hpp>
#include <scifi/material/materials.hpp>

namespace scifi {

/// The library's own material of this name, or nothing.
[[nodiscard]] inline std::optional<material> built_in_material(std::string_view name) {
  for (const material& m : {materials::polystyrene, materials::mylar, materials::helium, materials::aluminium, materials::liquid_hydrogen,
                            materials::lithium_hydride, materials::air, materials::vacuum})
    if (m.name == name) return m;
  return std::nullopt;
}

/// <Z/A> (mol/g) of a chemical formula such as "C10H8O4", without brackets, from the standard atomic weights (IUPAC 2021); nothing
/// for a formula that is not understood or names an element that is not in the table.
[[nodiscard]] inline std::optional<double> z_over_a_of_formula(std::string_view formula) {
  struct element {
    std::string_view symbol;
    int z;
    double a;
  };
  static constexpr std::array elements{element{"H", 1, 1.008},    element{"He", 2, 4.0026},  element{"Li", 3, 6.94},    element{"Be", 4, 9.0122},
                                       element{"B", 5, 10.81},    element{"C", 6, 12.011},   element{"N", 7, 14.007},   element{"O", 8, 15.999},
                                       element{"F", 9, 18.998},   element{"Ne", 10, 20.180}, element{"Na", 11, 22.990}, element{"Mg", 12, 24.305},
                                       element{"Al", 13, 26.982}, element{"Si", 14, 28.085}, element{"P", 15, 30.974},  element{"S", 16, 32.06},
                                       element{"Cl", 17, 35.45},  element{"Ar", 18, 39.95},  element{"Ca", 20, 40.078}, element{"Ti", 22, 47.867},
                                       element{"Fe", 26, 55.845}, element{"Ni", 28, 58.693}, element{"Cu", 29, 63.546}, element{"Ge", 32, 72.630},
                                       element{"Xe", 54, 131.29}, element{"W", 74, 183.84},  element{"Pb", 82, 207.2}};
  double z = 0.0;
  double a = 0.0;
  while (!formula.empty()) {
    std::size_t letters = 1;
    while (letters < formula.size() && std::islower(static_cast<unsigned char>(formula[letters])) != 0) ++letters;
    const std::string_view symbol = formula.substr(0, letters);
    formula.remove_prefix(letters);
    std::size_t digits = 0;
    while (digits < formula.size() && std::isdigit(static_cast<unsigned char>(formula[digits])) != 0) ++digits;
    int count = 1;
    if (digits > 0 && std::from_chars(formula.data(), formula.data() + digits, count).ec != std::errc{}) return std::nullopt;
    formula.remove_prefix(digits);
    bool known = false;
    for (const element& e : elements) {
      if (e.symbol != symbol) continue;
      z += count * e.z;
      a += count * e.a;
      known = true;
    }
    if (!known) return std::nullopt;
  }
  return a > 0.0 ? std::optional(z / a) : std::nullopt;
}

/// Density-effect parameters of a medium without measured ones: the general expressions of Sternheimer and Peierls, Phys. Rev. B 3 (1971)
/// 3681, from mean excitation energy (MeV), density (g/cm3) and <Z/A>; below 0.01 g/cm3 the medium is taken for a gas.
/// They reproduce the stopping power of tabulated media within about 2 %.
[[nodiscard]] inline material::sternheimer sternheimer_peierls(double mean_excitation_energy, double density, double z_over_a) {
  constexpr double densest_gas = 0.01;
  constexpr double plasma_energy = 28.816 * units::eV;  // of a medium with density * Z/A = 1, PDG 2024 table 34.1
  if (density <= 0.0) return materials::vacuum.density_effect;
  const double c = 2.0 * std::log(mean_excitation_energy / (plasma_energy * std::sqrt(density * z_over_a))) + 1.0;
  double x0 = 0.2;
  double x1 = 3.0;
  if (density >= densest_gas) {
    const bool light = mean_excitation_energy < 100.0 * units::eV;
    x1 = light ? 2.0 : 3.0;
    if (c >= (light ? 3.681 : 5.215)) x0 = 0.326 * c - (light ? 1.0 : 1.5);
  } else {
    x1 = c < 12.25 ? 4.0 : 5.0;
    if (c < 10.0) x0 = 1.6;
    else if (c < 10.5) x0 = 1.7;
    else if (c < 11.0) x0 = 1.8;
    else if (c < 11.5) x0 = 1.9;
    else if (c < 13.804) x0 = 2.0;
    else x0 = 0.326 * c - 2.5;
  }
  constexpr double m = 3.0;
  const double a = (c - 2.0 * std::numbers::ln10 * x0) / std::pow(x1 - x0, m);
  return {a, m, x0, x1, c, 0.0};
}

/// A medium as `materials.NAME` describes it: density_g_cm3, radiation_length (mm, null: infinite), mean_excitation_energy_eV and formula
/// or z_over_a. What is left out is taken from the library's material of that name; another name needs all four.
/// Density effect: `density_effect` where given, else that of the library's material of that name moved to the density given
/// (C-bar, x0 and x1 follow the plasma energy), else `sternheimer_peierls`.
/// A name that the library does not have is kept as "of the geometry file". Throws input_error.
[[nodiscard]] inline material material_from_json(const json_field& from, const std::string& name) {
  const std::optional<material> known = built_in_material(name);
  material m = known.value_or(material{"of the geometry file", 0.0, 0.0, 0.0, 0.0, {}});
  const auto given = [&](const char* key) { return !known || from.has(key); };
  if (given("density_g_cm3")) m.density = from.at("density_g_cm3").number();
  if (m.density < 0.0) from.at("density_g_cm3").fail("is negative");
  if (given("radiation_length")) {
    const json_field length = from.at("radiation_length");
    m.radiation_length = length.is_null() ? std::numeric_limits<double>::infinity() : length.positive();
  } else if (m.density > 0.0) {
    m.radiation_length *= known->density / m.density;
  }
  if (given("mean_excitation_energy_eV")) m.mean_excitation_energy = from.at("mean_excitation_energy_eV").positive() * units::eV;
  if (from.has("z_over_a")) {
    m.z_over_a = from.at("z_over_a").number();
    if (m.z_over_a < 0.0 || m.z_over_a > 1.0) from.at("z_over_a").fail("is outside 0 .. 1");
  } else if (given("formula")) {
    const std::string formula = from.at("formula").text();
    const std::optional<double> z_over_a = z_over_a_of_formula(formula);
    if (!z_over_a) from.at("formula").fail(in_quotes(formula) + " is not understood; give z_over_a instead");
    m.z_over_a = *z_over_a;
  }
  if (from.has("density_effect")) {
    const json_field s = from.at("density_effect");
    m.density_effect = {s.at("a").number(), s.at("m").number(), s.at("x0").number(), s.at("x1").number(), s.at("c").number(), s.at("delta0").number()};
  } else if (!known) {
    m.density_effect = sternheimer_peierls(m.mean_excitation_energy, m.density, m.z_over_a);
  } else if (m.density > 0.0 && known->density > 0.0) {
    const double shift = std::log(m.density / known->density);
    m.density_effect.c -= shift;
    m.density_effect.x0 -= 0.5 * shift / std::numbers::ln10;
    m.density_effect.x1 -= 0.5 * shift / std::numbers::ln10;
  }
  return m;
}

}  // namespace scifi
