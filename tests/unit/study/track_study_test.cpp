// SPDX-License-Identifier: MPL-2.0
#include <cmath>
#include <vector>

#include "support/catch.hpp"
#include "support/flown_particle.hpp"

#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/information/mixture_spread.hpp>
#include <scifi/study/track_study.hpp>

using namespace scifi;
using namespace scifi::study;
using test::five;

namespace {

constexpr double field = 3.0 * units::tesla;
const detector trackers = mice::trackers();
const tracker& where = *trackers.find(1);

track fit_of(const vector<double, 5>& state) { return test::fitted_track(1, state, five(0.3, 0.3, 1, 1, 3)); }

}  // namespace

TEST_CASE("an event with a found and a missed particle, a ghost, a duplicate and a failed fit", "[study]") {
  const auto first = five(0, 0, 30, 0, 200), second = five(60, 0, 0, 30, 200);
  std::vector<crossing> crossings = test::flown_particle(where, 1, first, field);
  for (const crossing& c : test::flown_particle(where, 2, second, field)) crossings.push_back(c);
  event e;
  e.tracks = {fit_of(five(-80, 0, 0, 0, 200)), fit_of(five(0.3, 0, 30, 0, 203)), fit_of(five(2, 0, 30, 0, 203)), fit_of(second), fit_of(second)};
  e.tracks[3].status.why = kalman::reason::not_converged;
  e.tracks[4].tracker = 0;
  track_study study(where, {.field = field});
  const auto pairs = study.add(crossings, e);
  REQUIRE(pairs.size() == 2);
  CHECK(pairs[0].second == 1);
  CHECK(pairs[1].second == -1);
  CHECK(study.found.all().expected == 2);
  CHECK(study.found.all().found == 1);
  CHECK(study.tracks == 3);
  CHECK(study.failed == 1);
  CHECK(study.ghosts == 2);
  CHECK(study.duplicates == 1);
  CHECK(study.residuals.residual(residual_quantity::x).values.values()[0] == Approx(0.3));
  CHECK(study.goodness.p_value.values.size() == 1);
  REQUIRE(study.momentum.fine().at(5, 3).pz.residual.size() == 1);
  CHECK(study.momentum.fine().at(5, 3).pz.residual.values()[0] == Approx(3.0));
}

TEST_CASE("a particle that misses a station counts for the efficiency alone", "[study]") {
  std::vector<crossing> crossings = test::flown_particle(where, 1, five(0, 0, 30, 0, 200), field);
  crossings.pop_back();
  event e;
  e.tracks = {fit_of(five(0, 0, 30, 0, 200))};
  track_study study(where, {.field = field});
  study.add(crossings, e);
  CHECK(study.found.all().found == 1);
  CHECK(study.residuals.residual(residual_quantity::x).values.size() == 0);
}

TEST_CASE("studies of two halves of the events, merged, are the study of all", "[study]") {
  track_study all(where, {.field = field}), odd(where, {.field = field}), even(where, {.field = field});
  for (int i = 0; i < 20; ++i) {
    const vector<double, 5> start = five(i, -i, 10 + i, 5, 150 + 5 * i);
    const auto crossings = test::flown_particle(where, 1, start, field);
    event e;
    if (i % 7 != 0) e.tracks = {fit_of(start + five(0.1 * i, 0, 0.1, 0.2 * i, i - 10))};
    if (i % 5 == 0) e.tracks.push_back(fit_of(five(-100, 0, 0, 0, 200)));
    all.add(crossings, e);
    (i % 2 == 0 ? even : odd).add(crossings, e);
  }
  odd += even;
  CHECK(odd.found.all().found == all.found.all().found);
  CHECK(odd.ghosts == all.ghosts);
  CHECK(odd.tracks == all.tracks);
  CHECK(odd.with_tracks == all.with_tracks);
  for (const auto c : {residual_quantity::x, residual_quantity::pt, residual_quantity::pz}) {
    CHECK(odd.residuals.residual(c).values.sorted() == all.residuals.residual(c).values.sorted());
    CHECK(odd.residuals.bound(c).sorted() == all.residuals.bound(c).sorted());
    CHECK((odd.residuals.residual(c).histogram == all.residuals.residual(c).histogram));
  }
  CHECK(in_pt(odd.momentum.fine()).at(3).pz.residual.sorted() == in_pt(all.momentum.fine()).at(3).pz.residual.sorted());
}

TEST_CASE("beside each residual stands the bound of that track, for the true kind of particle", "[study]") {
  const vector<double, 5> start = five(0, 0, 30, 0, 200);
  event e;
  e.tracks = {fit_of(start)};
  const auto bound = [&](int pdg) {
    auto crossings = test::flown_particle(where, 1, start, field);
    for (crossing& c : crossings) c.pdg_id = pdg;
    track_study study(where, {.field = field});
    study.add(crossings, e);
    return study.residuals.bound(residual_quantity::pz).values()[0];
  };
  const double muon = kalman::sigma(make_track_bound(where, field)(start, 1).momentum, momentum_state::pz);
  CHECK(bound(-13) == Approx(muon));
  CHECK(bound(211) > muon);  // slower at the same momentum: it scatters more
}
