// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <cmath>

#include <scifi/material/straggling.hpp>

using namespace scifi;

TEST_CASE("Bohr's straggling of a slow heavy particle is the classical one", "[material]") {
  // Bohr 1915: sigma^2 = 4 pi N_A r_e^2 (m_e c^2)^2 rho Z/A x = 0.1569 rho Z/A x MeV^2 (Leo, Techniques (1994) eq. 2.101), for beta -> 0.
  const double variance = bohr_straggling{}.variance(30.0, proton, whole(materials::aluminium, 0.1), 1.0);
  CHECK(variance == Approx(0.1569 * 2.699 * 0.48181 * 0.01).epsilon(2e-3));
}

TEST_CASE("Straggling variances of slices add up, and the path counts", "[material]") {
  const auto check = [](const auto& policy) {
    const slab layer = whole(materials::polystyrene, 0.6273);
    const double expected = policy.variance(200.0, muon_plus, layer, 1.3);
    CHECK(expected > 0.0);
    for (const int n : {2, 50}) CHECK(n * policy.variance(200.0, muon_plus, split(layer, n), 1.3) == Approx(expected).epsilon(1e-12));
    CHECK(policy.variance(200.0, muon_plus, whole(materials::polystyrene, 1.3 * 0.6273), 1.0) == Approx(expected).epsilon(1e-12));
  };
  check(bohr_straggling{});
  check(landau_straggling{});
  check(landau_straggling{15.0});
}

TEST_CASE("Layers that know how many there are add up to the core of the total", "[material]") {
  const slab thin = whole(materials::polystyrene, 0.1), thick = whole(materials::polystyrene, 1.0);
  const double total = 10.0 * landau_straggling{10.0}.variance(400.0, muon_plus, thin, 1.0);
  CHECK(total == Approx(landau_straggling{}.variance(400.0, muon_plus, thick, 1.0)).epsilon(1e-12));
  // The core's full width is 4.018 xi, xi = 0.1535 Z/A rho x / beta^2.
  const double beta2 = 400.0 * 400.0 / (400.0 * 400.0 + 105.6583755 * 105.6583755);
  const double xi = 0.1535 * 0.53768 * 1.06 * 0.1 / beta2;
  CHECK(2.0 * std::sqrt(2.0 * std::log(2.0)) * std::sqrt(total) == Approx(4.018 * xi).epsilon(1e-3));
}

TEST_CASE("The core never straggles more than the whole distribution", "[material]") {
  for (const double p : {30.0, 100.0, 500.0}) {
    for (const double n : {1.0, 15.0, 1e4}) {
      const slab s = whole(materials::polystyrene, 0.6273);
      CHECK(landau_straggling{n}.variance(p, muon_plus, s, 1.0) <= bohr_straggling{}.variance(p, muon_plus, s, 1.0));
    }
  }
  CHECK(landau_straggling{}.variance(500.0, muon_plus, whole(materials::mylar, 0.025), 1.0) <
        0.01 * bohr_straggling{}.variance(500.0, muon_plus, whole(materials::mylar, 0.025), 1.0));
}

TEST_CASE("Zero thickness, vacuum and no_straggling straggle exactly nothing", "[material]") {
  for (const slab& s : {whole(materials::polystyrene, 0.0), whole(materials::vacuum, 100.0), slab{}}) {
    CHECK(bohr_straggling{}.variance(200.0, muon_plus, s, 1.0) == 0.0);
    CHECK(landau_straggling{}.variance(200.0, muon_plus, s, 1.0) == 0.0);
  }
  CHECK(no_straggling{}.variance(200.0, muon_plus, whole(materials::aluminium, 10.0), 1.0) == 0.0);
}

TEST_CASE("Single precision gives the straggling to single precision", "[material]") {
  const slab s = whole(materials::polystyrene, 0.6273);
  CHECK(static_cast<double>(landau_straggling{}.variance(200.0f, muon_plus, s, 1.25f)) ==
        Approx(landau_straggling{}.variance(200.0, muon_plus, s, 1.25)).epsilon(3e-6));
  CHECK(static_cast<double>(bohr_straggling{}.variance(200.0f, muon_plus, s, 1.25f)) ==
        Approx(bohr_straggling{}.variance(200.0, muon_plus, s, 1.25)).epsilon(3e-6));
}
