// SPDX-License-Identifier: MPL-2.0
#include <scifi/geometry/tracker.hpp>

#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"

namespace {

scifi::detector small() {
  scifi::detector d;
  for (const int id : {7, 3}) {
    scifi::tracker t;
    t.id = id;
    for (const int station : {1, 4}) {
      scifi::station s;
      s.id = station;
      s.planes.resize(2);
      s.planes[0].channels = 100 * id + 10 * station;
      s.planes[1].channels = 100 * id + 10 * station + 1;
      t.stations.push_back(s);
    }
    d.trackers.push_back(t);
  }
  return d;
}

}  // namespace

TEST_CASE("a tracker is found by its id, not by its place", "[geometry]") {
  const scifi::detector d = small();
  REQUIRE(d.find(3) != nullptr);
  CHECK(d.find(3)->id == 3);
  CHECK(d.find(7) == &d.trackers[0]);
  CHECK(d.find(0) == nullptr);
  CHECK(scifi::detector{}.find(0) == nullptr);
}

TEST_CASE("the plane of a channel is found by tracker, station and plane", "[geometry]") {
  const scifi::detector d = small();
  REQUIRE(d.find_plane({3, 4, 1, 0}) != nullptr);
  CHECK(d.find_plane({3, 4, 1, 0})->channels == 341);
  CHECK(d.find_plane({7, 1, 0, 999})->channels == 710);
}

TEST_CASE("a channel whose tracker, station or plane does not exist has no plane", "[geometry]") {
  const scifi::detector d = small();
  CHECK(d.find_plane({2, 1, 0, 0}) == nullptr);
  CHECK(d.find_plane({3, 2, 0, 0}) == nullptr);
  CHECK(d.find_plane({3, 4, 2, 0}) == nullptr);
  CHECK(d.find_plane({3, 4, -1, 0}) == nullptr);
}

TEST_CASE("a tracker in which nothing can be found is refused by the name of what is wrong", "[geometry]") {
  const auto message = [](const scifi::tracker& t) { return scifi::test::message_of<std::invalid_argument>([&t] { scifi::check(t); }); };
  const scifi::tracker good = scifi::mice::trackers().trackers[scifi::mice::downstream];
  CHECK(message(good) == "(no error)");
  scifi::tracker crossed = good;  // both sides of one sensor
  for (scifi::station& s : crossed.stations)
    for (scifi::plane& p : s.planes) p.z_measured = 0.0;
  CHECK(message(crossed) == "(no error)");
  crossed.stations[1].in_tracker.origin.z() = crossed.stations[0].in_tracker.origin.z();
  CHECK(message(crossed).find("tracker TKD: plane 0 of station 2, at z = ") == 0);

  scifi::tracker swapped = good;
  std::swap(swapped.stations[1], swapped.stations[3]);
  CHECK(message(swapped).find("tracker TKD: plane 0 of station 3, at z = ") == 0);
  CHECK(message(swapped).find("must lie behind plane 2 of station 4, at z = ") != std::string::npos);
  // Positions in metres beside planes in millimetres.
  scifi::tracker metres = good;
  for (scifi::station& s : metres.stations) s.in_tracker.origin *= 1e-3;
  CHECK(message(metres).find("plane 0 of station 2") != std::string::npos);
  scifi::tracker unknown = good;
  unknown.stations[0].in_tracker.origin.z() = std::numeric_limits<double>::quiet_NaN();
  scifi::tracker pointlike = good;
  pointlike.active_radius = 0.0;
  CHECK(message(pointlike).find("tracker TKD: active_radius must be above zero") == 0);
  scifi::tracker blind = good;
  blind.stations[2].planes[1].channels = 0;
  CHECK(message(blind) == "tracker TKD: plane 1 of station 3 has no channels, or none of a width above zero");
  blind = good;
  blind.stations[0].planes[0].channel_width = 0.0;
  CHECK(message(blind).find("plane 0 of station 1 has no channels") != std::string::npos);
  CHECK(message(unknown).find("plane 1 of station 1, at z = nan mm") != std::string::npos);
}
