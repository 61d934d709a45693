// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>

#include <scifi/core/units.hpp>
#include <scifi/material/bethe.hpp>
#include <scifi/material/material.hpp>

using namespace scifi;

namespace {

// Sternheimer, Berger, Seltzer 1984: I = 75.0 eV, to which the density-effect parameters belong (C = 2 ln(I / 21.47 eV) + 1).
constexpr material water{"water", 1.000, 360.8, 0.55509, 75.0 * units::eV, {0.09116, 3.4773, 0.2400, 2.8004, 3.5017, 0.0}};

}  // namespace

TEST_CASE("A medium of one's own is its constants and nothing else", "[material]") {
  // Groom, Mokhov, Striganov 2001, table 1, with the same constants: minimum ionisation 1.992 MeV cm2/g.
  double smallest = 1e9;
  for (double p = 200.0; p < 800.0; p *= 1.002) smallest = std::min(smallest, mean_energy_loss_rate(p, muon_minus, water).value * units::cm);
  CHECK(smallest == Approx(1.992).epsilon(1e-3));
  // delta = 2 ln(beta gamma) - C above x1 = 2.8004.
  CHECK(density_effect(1e3, water.density_effect).value == Approx(2.0 * std::log(1e3) - 3.5017).epsilon(1e-12));
}
