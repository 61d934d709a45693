// SPDX-License-Identifier: MPL-2.0
#include <scifi/geometry/surface.hpp>

#include <algorithm>
#include <cmath>

#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"

using scifi::surface;
using scifi::surfaces_along;

namespace {

/// Two stations, given with the further one first; the near one is shifted and turned. Materials tell the sides of each plane apart.
scifi::tracker two_stations() {
  scifi::tracker t;
  for (const int id : {2, 1}) {
    scifi::station s;
    s.id = id;
    s.in_tracker.origin = id == 1 ? scifi::vector<double, 3>(1.5, -2.0, 0.0) : scifi::vector<double, 3>(0.0, 0.0, 300.0);
    s.in_tracker.angle = id == 1 ? 0.1 : 0.0;
    for (const int i : {0, 1}) {
      scifi::plane p;
      p.angle = 0.5 * i;
      p.z_reference = 2.0 * i;
      p.z_measured = 2.0 * i + 0.5;
      p.below.add(scifi::whole(scifi::materials::mylar, 0.1)).add(scifi::whole(scifi::materials::polystyrene, 0.4));
      p.above.add(scifi::whole(scifi::materials::aluminium, 0.3));
      s.planes.push_back(p);
    }
    t.stations.push_back(s);
  }
  return t;
}

}  // namespace

TEST_CASE("a traveller meets the surfaces in order of z along its direction", "[geometry]") {
  const auto up = surfaces_along(two_stations(), +1);
  const auto down = surfaces_along(two_stations(), -1);
  REQUIRE(up.size() == 4);
  REQUIRE(down.size() == 4);
  const int stations[] = {1, 1, 2, 2}, planes[] = {0, 1, 0, 1};
  const double z[] = {0.5, 2.5, 300.5, 302.5};
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(up[i].station == stations[i]);
    CHECK(up[i].plane == planes[i]);
    CHECK(up[i].z == z[i]);
    CHECK(up[i].z_reference == z[i] - 0.5);
    CHECK(down[i].station == up[3 - i].station);
    CHECK(down[i].plane == up[3 - i].plane);
    CHECK(down[i].z == up[3 - i].z);
  }
}

TEST_CASE("the stacks of a surface keep their order of growing z in both directions", "[geometry]") {
  for (const int direction : {+1, -1})
    for (const surface& s : surfaces_along(two_stations(), direction)) {
      REQUIRE(s.below.size() == 2);
      REQUIRE(s.above.size() == 1);
      CHECK(s.below[0].medium.name == "mylar");
      CHECK(s.below[1].medium.name == "polystyrene");
      CHECK(s.above[0].medium.name == "aluminium");
    }
}

TEST_CASE("a surface measures what the frames of its tracker, station and plane say one after the other", "[geometry]") {
  const scifi::tracker t = two_stations();
  for (const surface& at : surfaces_along(t, +1)) {
    const scifi::station& s = *std::find_if(t.stations.begin(), t.stations.end(), [&at](const scifi::station& one) { return one.id == at.station; });
    const scifi::plane& p = s.planes[static_cast<std::size_t>(at.plane)];
    for (const double x : {-20.0, 0.0, 33.0})
      for (const double y : {-7.0, 0.0, 60.0}) {
        const auto inside = p.in_station().parent_to_child(s.in_tracker.parent_to_child({x, y, at.z}));
        CHECK(at.tracker_to_alpha(x, y) == Approx(inside.x()).margin(1e-13));
        CHECK(std::abs(inside.z()) < 1e-12);
      }
  }
}

TEST_CASE("the material between the first and the last surface of a tracker is the same in both directions", "[geometry]") {
  const auto sum = [](const std::vector<surface>& way) {
    double total = 0.0;
    for (const surface& s : way) total += scifi::radiation_lengths(s.below) + scifi::radiation_lengths(s.above);
    return total;
  };
  const scifi::tracker t = scifi::mice::trackers().trackers[0];
  CHECK(sum(surfaces_along(t, +1)) == Approx(sum(surfaces_along(t, -1))).epsilon(1e-14));
  CHECK(surfaces_along(t, +1).size() == 15);
}
