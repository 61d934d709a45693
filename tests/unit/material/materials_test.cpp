// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <scifi/material/materials.hpp>

using namespace scifi;

namespace {

struct element {
  double z, a, x0;  // x0 in g/cm2: Tsai, Rev. Mod. Phys. 46 (1974) 815, as in the PDG's table of elements
};
constexpr element hydrogen{1, 1.00794, 63.04}, lithium{3, 6.941, 82.78}, carbon{6, 12.0107, 42.70}, nitrogen{7, 14.0067, 37.99}, oxygen{8, 15.9994, 34.24},
    argon{18, 39.948, 19.55};

struct mixture {
  double z_over_a, radiation_length;
};

// Bragg's rule: <Z/A> = sum w Z/A, 1/X0 = sum w/X0 (PDG 2024 eq. 34.26), for atoms in a molecule.
mixture of_atoms(const std::vector<std::pair<element, double>>& atoms) {
  double mass = 0.0, z = 0.0, inverse = 0.0;
  for (const auto& [e, n] : atoms) {
    mass += n * e.a;
    z += n * e.z;
    inverse += n * e.a / e.x0;
  }
  return {z / mass, mass / inverse};
}

void check(const material& m, const mixture& expected) {
  CHECK(m.z_over_a == Approx(expected.z_over_a).epsilon(2e-4));
  CHECK(m.radiation_length / 10.0 * m.density == Approx(expected.radiation_length).epsilon(2e-3));
}

}  // namespace

TEST_CASE("Compounds follow from their atoms by Bragg's rule", "[material]") {
  check(materials::polystyrene, of_atoms({{carbon, 8}, {hydrogen, 8}}));
  check(materials::mylar, of_atoms({{carbon, 10}, {hydrogen, 8}, {oxygen, 4}}));
  check(materials::lithium_hydride, of_atoms({{lithium, 1}, {hydrogen, 1}}));
  check(materials::liquid_hydrogen, of_atoms({{hydrogen, 1}}));
  // Air by weight fractions: C 0.000124, N 0.755267, O 0.231781, Ar 0.012827 (Seltzer, Berger 1982).
  check(materials::air, of_atoms({{carbon, 0.000124 / 12.0107}, {nitrogen, 0.755267 / 14.0067}, {oxygen, 0.231781 / 15.9994}, {argon, 0.012827 / 39.948}}));
}

TEST_CASE("Elements have the ratio of their atomic number to their atomic weight", "[material]") {
  CHECK(materials::helium.z_over_a == Approx(2 / 4.002602).epsilon(2e-5));
  CHECK(materials::aluminium.z_over_a == Approx(13 / 26.9815385).epsilon(2e-5));
}

TEST_CASE("Radiation lengths in length units are the PDG's", "[material]") {
  CHECK(materials::polystyrene.radiation_length == Approx(413.1).epsilon(3e-4));
  CHECK(materials::aluminium.radiation_length == Approx(88.97).epsilon(3e-4));
  CHECK(materials::liquid_hydrogen.radiation_length == Approx(8904.0).epsilon(3e-4));
  CHECK(materials::lithium_hydride.radiation_length == Approx(971.0).epsilon(3e-4));
  CHECK(materials::mylar.radiation_length == Approx(285.4).epsilon(3e-4));
  CHECK(materials::air.radiation_length == Approx(3.039e5).epsilon(3e-4));
  CHECK(materials::helium.radiation_length == Approx(5.671e6).epsilon(3e-4));
}

TEST_CASE("The density-effect constant C follows from the plasma energy", "[material]") {
  // C = 2 ln(I / h nu_p) + 1, h nu_p = 28.816 sqrt(rho Z/A) eV (PDG 2024 table 34.1, eq. 34.6). C is tabulated to 1e-4, rho to 1e-3.
  // Mylar, air and helium gas are tabulated at the density of 1984, hence the wider margin.
  for (const material& m : {materials::polystyrene, materials::mylar, materials::helium, materials::aluminium, materials::liquid_hydrogen,
                            materials::lithium_hydride, materials::air}) {
    INFO(m.name);
    const double plasma_energy = 28.816e-6 * std::sqrt(m.density * m.z_over_a);
    CHECK(m.density_effect.c == Approx(2.0 * std::log(m.mean_excitation_energy / plasma_energy) + 1.0).margin(6e-3));
  }
}

TEST_CASE("A medium at another density keeps its radiation length in grams", "[material]") {
  constexpr material light = materials::at_density(materials::lithium_hydride, 0.6957);
  CHECK(light.density == 0.6957);
  CHECK(light.radiation_length * light.density == Approx(materials::lithium_hydride.radiation_length * 0.820).epsilon(1e-12));
}
