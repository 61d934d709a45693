// SPDX-License-Identifier: MPL-2.0
#include <cmath>
#include <random>
#include <vector>

#include "support/catch.hpp"
#include "support/flown_particle.hpp"

#include <scifi/geometry/mice.hpp>
#include <scifi/study/momentum_resolution.hpp>

using namespace scifi;
using namespace scifi::study;
using test::five;

TEST_CASE("a track fills its cell with residuals, stated errors and the bound", "[study]") {
  const detector d = mice::trackers();
  const std::vector<crossing> crossings = test::flown_particle(*d.find(1), 1, five(0, 0, 30, 40, 200), 0.9);
  const true_track particle = true_tracks(*d.find(1), crossings).at(0);
  track t = test::fitted_track(1, five(0, 0, 33, 44, 198), five(1, 1, 1, 2, 4));
  t.reference.covariance(2, 3) = t.reference.covariance(3, 2) = 0.5;
  reference_bound limit;
  limit.momentum = {particle.state(), matrix<double, 5, 5>::Identity() * 9.0};
  limit.pt = 0.9;
  momentum_resolution a, b;
  a.add(particle, t, limit);
  b.add(particle, t, limit);
  a += b;
  const momentum_cell& cell = a.fine().at(7, 3);  // pt 50 to 70, pz 190 to 220
  REQUIRE(cell.pt.residual.size() == 2);
  CHECK(cell.pt.residual.values()[0] == Approx(5.0));
  CHECK(cell.pz.residual.values()[1] == Approx(-2.0));
  CHECK(cell.pz.stated.values()[0] == Approx(4.0));
  CHECK(cell.pt.stated.values()[0] == Approx(std::sqrt(0.36 * 1.0 + 0.64 * 4.0 + 2 * 0.48 * 0.5)));
  CHECK(cell.pt.bound.values()[0] == 0.9);
  CHECK(cell.pz.bound.values()[0] == Approx(3.0));
  CHECK(a.wide().at(5, 1).pz.residual.size() == 2);  // pt 50 to 90, pz 160 to 220
  t.shape = track_shape::line;
  a.add(particle, t, limit);
  CHECK(a.fine().at(7, 3).pt.residual.size() == 2);
}

TEST_CASE("a shift counts beyond three per cent of the spread with more than two hundred tracks", "[study]") {
  summary s;
  s.spread = 2.0;
  s.median = -0.07;
  s.count = 201;
  CHECK(shift_rule{}(s));
  s.count = 200;
  CHECK_FALSE(shift_rule{}(s));
  s.count = 5000;
  s.median = 0.059;
  CHECK_FALSE(shift_rule{}(s));
}

TEST_CASE("how often a cell without a shift counts as shifted is what normal samples give", "[study]") {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  int shifted = 0;
  double by_chance = 0.0;
  constexpr int trials = 1000;
  for (int i = 0; i < trials; ++i) {
    sample s;
    for (int j = 0; j < 300; ++j) s.add(normal(random));
    shifted += shift_rule{}(summarise(s)) ? 1 : 0;
    by_chance += shift_rule{}.by_chance(summarise(s)) / trials;
  }
  // 0.03 against an error of 1.2533/sqrt(300) = 0.0724: erfc(0.415/sqrt(2)) = 0.678. Three standard errors of the share seen.
  CHECK(by_chance == Approx(0.678).margin(0.001));
  CHECK(shifted / double(trials) == Approx(0.678).margin(3.0 * std::sqrt(0.678 * 0.322 / trials)));
  summary few;
  few.count = 200;
  CHECK(shift_rule{}.by_chance(few) == 0.0);
}
