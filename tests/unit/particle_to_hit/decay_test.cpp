// SPDX-License-Identifier: MPL-2.0
#include <scifi/particle_to_hit/decay.hpp>

#include <algorithm>
#include <cmath>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("only muons and charged pions decay", "[particle_to_hit]") {
  CHECK(mean_life(muon_plus) == Approx(2196.98).epsilon(1e-5));
  CHECK(mean_life(muon_minus) == mean_life(muon_plus));
  CHECK(mean_life(pion_minus) == Approx(26.033));
  random_stream random(1, 0, 0);
  for (const particle& stable : {electron, positron, proton, antiproton}) {
    CHECK(std::isinf(mean_life(stable)));
    moving_particle m;
    m.hypothesis = stable;
    CHECK_FALSE(charged_daughter(m, random));
  }
}

TEST_CASE("a pion at rest gives a muon of 29.8 MeV/c in any direction", "[particle_to_hit]") {
  random_stream random(2, 0, 0);
  moving_particle pion;
  pion.hypothesis = pion_minus;
  pion.position = {1.0, 2.0, 3.0};
  pion.t = 4.0;
  constexpr int n = 4000;
  vector<double, 3> sum = vector<double, 3>::Zero();
  for (int i = 0; i < n; ++i) {
    const auto muon = charged_daughter(pion, random);
    REQUIRE(muon);
    REQUIRE(muon->hypothesis.pdg_id == muon_minus.pdg_id);
    REQUIRE(muon->momentum.norm() == Approx(29.79).epsilon(1e-3));  // PDG 2024
    REQUIRE(muon->position == pion.position);
    REQUIRE(muon->t == 4.0);
    sum += muon->momentum / muon->momentum.norm();
  }
  CHECK(sum.norm() / n < 5.0 / std::sqrt(static_cast<double>(n)));
}

TEST_CASE("the electron of a muon at rest has Michel's spectrum", "[particle_to_hit]") {
  random_stream random(3, 0, 0);
  moving_particle muon;
  constexpr int n = 20000;
  double sum = 0.0, below_half = 0.0, largest = 0.0;
  for (int i = 0; i < n; ++i) {
    const auto e = charged_daughter(muon, random);
    REQUIRE(e);
    REQUIRE(e->hypothesis.pdg_id == positron.pdg_id);
    const double x = e->energy() / 52.83;
    sum += x / n;
    below_half += x < 0.5 ? 1.0 / n : 0.0;
    largest = std::max(largest, x);
  }
  // Density 2 x^2 (3 - 2x): mean 7/10, mean square 8/15, 3/16 below one half.
  const double five = 5.0 / std::sqrt(static_cast<double>(n));
  CHECK(std::abs(sum - 0.7) < five * std::sqrt(8.0 / 15.0 - 0.49));
  CHECK(std::abs(below_half - 0.1875) < five * std::sqrt(0.1875 * 0.8125));
  CHECK(largest <= 1.0001);
  CHECK(largest > 0.99);
}

TEST_CASE("a boost keeps the mass and adds velocities", "[particle_to_hit]") {
  moving_particle parent;
  parent.momentum = {30.0, -40.0, 180.0};
  CHECK((boosted(vector<double, 3>::Zero(), muon_plus.mass, parent) - parent.momentum).norm() < 1e-12);
  // Along the flight of the parent: E' = gamma (E + beta p).
  const vector<double, 3> forward = parent.momentum.normalized();
  const double gamma = parent.energy() / muon_plus.mass;
  const double beta_gamma = parent.momentum.norm() / muon_plus.mass;
  const double energy = std::hypot(20.0, 5.0);
  const vector<double, 3> along = boosted(20.0 * forward, 5.0, parent);
  CHECK(along.dot(forward) == Approx(gamma * 20.0 + beta_gamma * energy));
  // Invariant: E' of the parent's rest frame, (E_a E_b - p_a p_b) / m.
  const vector<double, 3> any = boosted({3.0, 7.0, -11.0}, 5.0, parent);
  const double invariant = (std::hypot(any.norm(), 5.0) * parent.energy() - any.dot(parent.momentum)) / muon_plus.mass;
  CHECK(invariant == Approx(std::hypot(std::sqrt(9.0 + 49.0 + 121.0), 5.0)));
}
