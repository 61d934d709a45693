// SPDX-License-Identifier: MPL-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include "support/catch.hpp"
#include "support/flown_particle.hpp"

#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/study/true_track.hpp>

using namespace scifi;
using namespace scifi::study;
using test::five;

namespace {

const tracker& downstream() {
  static const detector d = mice::trackers();
  return *d.find(mice::downstream);
}
constexpr double field = 3.0 * units::tesla;

}  // namespace

TEST_CASE("a particle through all planes has five stations and its state at the reference surface", "[study]") {
  const vector<double, 5> start = five(10, -20, 30, 40, 200);
  const std::vector<crossing> crossings = test::flown_particle(downstream(), 7, start, field);
  const auto tracks = true_tracks(downstream(), crossings);
  REQUIRE(tracks.size() == 1);
  CHECK(tracks[0].particle == 7);
  CHECK(tracks[0].charge == 1);
  CHECK(tracks[0].complete_stations == 5);
  CHECK(tracks[0].first_complete);
  CHECK(tracks[0].state() == start);
  CHECK(tracks[0].pt() == Approx(50.0));
  CHECK(tracks[0].at.size() == 15);
  CHECK(tracks[0].expected({}));
}

TEST_CASE("what makes a particle not expected", "[study]") {
  const auto seen = [](std::vector<crossing> crossings) { return true_tracks(downstream(), crossings).at(0); };
  const auto without = [](std::vector<crossing> from, int station, int plane) {
    std::erase_if(from, [&](const crossing& c) { return c.station == station && c.plane == plane; });
    return from;
  };
  const std::vector<crossing> good = test::flown_particle(downstream(), 1, five(0, 0, 30, 0, 200), field);
  CHECK(seen(without(good, 3, 1)).expected({}));
  std::vector<crossing> two_stations_short = without(without(good, 3, 1), 5, 0);
  CHECK(true_tracks(downstream(), two_stations_short).at(0).complete_stations == 3);
  CHECK_FALSE(true_tracks(downstream(), two_stations_short).at(0).expected({}));
  std::vector<crossing> first_incomplete = without(good, 1, 2);
  CHECK(true_tracks(downstream(), first_incomplete).at(0).complete_stations == 4);
  CHECK_FALSE(true_tracks(downstream(), first_incomplete).at(0).expected({}));
  std::vector<crossing> no_reference = without(good, 1, 0);
  CHECK(true_tracks(downstream(), no_reference).at(0).reference() == nullptr);
  CHECK_FALSE(true_tracks(downstream(), no_reference).at(0).expected({}));
  std::vector<crossing> steep = test::flown_particle(downstream(), 1, five(0, 100, 90, 0, 175), field);
  CHECK_FALSE(true_tracks(downstream(), steep).at(0).expected({}));
  CHECK(true_tracks(downstream(), steep).at(0).expected({.min_stations = 4, .max_pt_over_pz = 0.6}));
  std::vector<crossing> outside = test::flown_particle(downstream(), 1, five(149.9, 0, 1, 0, 200), 0.0);
  CHECK(true_tracks(downstream(), outside).at(0).complete_stations == 1);  // leaves 150 mm after 20 mm of the way
}

TEST_CASE("particles are told apart, other trackers passed over, the last of several crossings of a plane counts", "[study]") {
  std::vector<crossing> crossings = test::flown_particle(downstream(), 5, five(0, 0, 30, 0, 200), field);
  const std::vector<crossing> second = test::flown_particle(downstream(), 2, five(50, 0, 30, 0, 150), field);
  crossings.insert(crossings.begin() + 4, second.begin(), second.end());
  crossing elsewhere = crossings[0];
  elsewhere.tracker = mice::upstream;
  crossings.push_back(elsewhere);
  crossing again = crossings[0];
  again.pdg_id = 13;
  again.position.x() = 33.0;
  crossings.push_back(again);
  const auto tracks = true_tracks(downstream(), crossings);
  REQUIRE(tracks.size() == 2);
  CHECK(tracks[0].particle == 2);
  CHECK(tracks[1].particle == 5);
  CHECK(tracks[1].reference()->position.x() == 33.0);
  CHECK(tracks[0].reference()->momentum.z() == 150.0);
}
