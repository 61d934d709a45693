// SPDX-License-Identifier: MPL-2.0
#include <scifi/geometry/tracker.hpp>

#include "support/catch.hpp"

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
