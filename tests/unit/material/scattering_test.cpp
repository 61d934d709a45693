// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <cmath>

#include <scifi/material/scattering.hpp>

using namespace scifi;

TEST_CASE("Highland scattering takes the true path in slab and logarithm", "[material]") {
  // At 60 degrees a layer is as thick as one of twice the thickness at normal incidence.
  const highland_scattering policy;
  const double oblique = policy.variance(200.0, muon_plus, whole(materials::polystyrene, 0.6273), 2.0);
  const double twice = policy.variance(200.0, muon_plus, whole(materials::polystyrene, 1.2546), 1.0);
  CHECK(oblique == Approx(twice).epsilon(1e-13));
  CHECK(oblique > 2.0 * policy.variance(200.0, muon_plus, whole(materials::polystyrene, 0.6273), 1.0));
}

TEST_CASE("A fibre plane scatters a 200 MeV/c muon by 2.3 mrad", "[material]") {
  // By hand from PDG 2024 eq. 34.16: x/X0 = 0.6273/413.1 = 1.5185e-3, beta = 0.88422, ln(x/(X0 beta^2)) = -6.2438:
  // 13.6/(0.88422*200) * 0.038968 * (1 - 0.23726) = 2.2857e-3.
  const highland_scattering policy;
  CHECK(std::sqrt(policy.variance(200.0, muon_plus, whole(materials::polystyrene, 0.6273), 1.0)) == Approx(2.2857e-3).epsilon(1e-4));
}

TEST_CASE("N slices scatter like one slab at any angle", "[material]") {
  const highland_scattering policy;
  const slab layer = whole(materials::aluminium, 3.0);
  for (const double path : {1.0, 1.3}) {
    const double expected = policy.variance(150.0, pion_plus, layer, path);
    for (const int n : {2, 10, 333}) CHECK(n * policy.variance(150.0, pion_plus, split(layer, n), path) == Approx(expected).epsilon(1e-12));
  }
}

TEST_CASE("A stack regarded as one layer scatters by the logarithm of the sum", "[material]") {
  // Equal media: the stack of two halves taken as one layer is the slab.
  const highland_scattering policy;
  slab_stack<> halves;
  halves.add(whole(materials::mylar, 0.5)).add(whole(materials::mylar, 0.5));
  double sum = 0.0, merged = 0.0;
  for (const slab& s : halves) sum += policy.variance(200.0, muon_plus, s, 1.0);
  for (const slab& s : as_one_layer(halves)) merged += policy.variance(200.0, muon_plus, s, 1.0);
  CHECK(merged == Approx(policy.variance(200.0, muon_plus, whole(materials::mylar, 1.0), 1.0)).epsilon(1e-13));
  CHECK(merged > sum);
}

TEST_CASE("Vacuum, zero thickness and no_scattering scatter exactly nothing", "[material]") {
  const highland_scattering policy;
  CHECK(policy.variance(200.0, muon_plus, whole(materials::vacuum, 500.0), 1.0) == 0.0);
  CHECK(policy.variance(200.0, muon_plus, whole(materials::polystyrene, 0.0), 1.0) == 0.0);
  CHECK(policy.variance(200.0, muon_plus, slab{}, 1.0) == 0.0);
  CHECK(no_scattering{}.variance(200.0, muon_plus, whole(materials::aluminium, 50.0), 1.0) == 0.0);
}
