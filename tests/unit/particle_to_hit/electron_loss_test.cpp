// SPDX-License-Identifier: MPL-2.0
#include <scifi/particle_to_hit/electron_loss.hpp>

#include <cmath>

#include <scifi/material/materials.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

// Liquid water, PDG and Sternheimer, Berger, Seltzer (1984): the medium of the best known tables.
constexpr material water{"water", 1.0, 360.8, 0.55509, 75.0 * units::eV, {0.09116, 3.4773, 0.2400, 2.8004, 3.5017, 0.0}};

}  // namespace

TEST_CASE("electrons lose in water what ICRU report 37 says", "[particle_to_hit]") {
  struct row {
    double kinetic_energy, loss;  // MeV, MeV cm2/g
  };
  for (const row& r : {row{0.01, 22.56}, row{0.1, 4.115}, row{1.0, 1.849}, row{10.0, 1.968}}) {
    CAPTURE(r.kinetic_energy);
    CHECK(electron_stopping_power(r.kinetic_energy, water) * units::cm == Approx(r.loss).epsilon(0.005));
  }
}

TEST_CASE("the loss goes with the density", "[particle_to_hit]") {
  material light = materials::polystyrene;
  light.density *= 0.5;
  CHECK(electron_stopping_power(0.3, light) == Approx(0.5 * electron_stopping_power(0.3, materials::polystyrene)));
}

TEST_CASE("the mean cosine after a path follows from the mean of single scatters", "[particle_to_hit]") {
  // Integral of (1 - cos) dn over all angles, with dn = (chi_c^2/2) dmu / (mu + chi_a^2/2)^2, mu = 1 - cos, in steps of ln(mu + chi_a^2/2).
  const double p = 0.3;
  const auto [chi_c2, chi_a2] = screened_coulomb_of(p, electron, 1.0 / materials::polystyrene.radiation_length, 6.0, screening::moliere);
  const double a = 0.5 * chi_a2;
  constexpr int steps = 20000;
  const double width = std::log((2.0 + a) / a) / steps;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double shifted = a * std::exp((i + 0.5) * width);
    sum += 0.5 * chi_c2 * (shifted - a) / shifted * width;
  }
  CHECK(electron_transport_rate(p, electron, materials::polystyrene) == Approx(sum).epsilon(1e-5));
}
