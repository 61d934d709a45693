// SPDX-License-Identifier: MPL-2.0
#include <scifi/particle_to_hit/screened_coulomb.hpp>

#include <scifi/material/materials.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("single scattering has the strength and screening of Moliere's theory", "[particle_to_hit]") {
  // Bethe (1953), eq. 10: chi_c^2 = 0.157 Z (Z + 1) / A x / (p beta)^2, x in g/cm2; for the C8H8 of polystyrene sum(w Z (Z + 1) / A) with the
  // hydrogen's and carbon's weights 0.0774 and 0.9226 is 3.38. The radiation length says the same to some per cent.
  const double x0 = 43.79;  // g/cm2
  const auto [chi_c2, chi_a2] = screened_coulomb_of(200.0, muon_plus, 1.0 / x0, 6.0, screening::moliere);
  const double beta2 = 200.0 * 200.0 / (200.0 * 200.0 + muon_plus.mass * muon_plus.mass);
  CHECK(chi_c2 == Approx(0.157 * 3.38 / (200.0 * 200.0 * beta2)).epsilon(0.03));
  // Eq. 15 there: chi_0 = hbar / (p 0.885 a_0 Z^(-1/3)); hbar c / a_0 = 3.7289 keV.
  const double chi_0 = 3.7289e-3 * 1.817121 / (0.885 * 200.0);
  CHECK(chi_a2 == Approx(chi_0 * chi_0 * (1.13 + 3.76 * 36.0 / (137.036 * 137.036 * beta2))).epsilon(1e-4));
}

TEST_CASE("screening factors: Wentzel's lies between twice and once Moliere's", "[particle_to_hit]") {
  CHECK(screening::wentzel(0.0) == 2.0);
  CHECK(screening::wentzel(6.0) == Approx(1.9646).epsilon(1e-4));
  CHECK(screening::wentzel(100.0) == Approx(screening::moliere).epsilon(1e-4));
  const auto once = screened_coulomb_of(150.0, muon_plus, 0.002, 6.0, 1.0);
  const auto twice = screened_coulomb_of(150.0, muon_plus, 0.002, 6.0, 2.0);
  CHECK(twice.chi_a2 == Approx(2.0 * once.chi_a2));
  CHECK(twice.chi_c2 == once.chi_c2);
}
