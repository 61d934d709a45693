// SPDX-License-Identifier: MPL-2.0
#include <scifi/geometry/along_beam.hpp>

#include <cmath>

#include <Eigen/Geometry>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"

TEST_CASE("the beam meets the stations of a drawing in order of z, the trackers the gap apart", "[geometry]") {
  const scifi::detector d = scifi::mice::trackers();
  const auto places = scifi::along_beam(d, 450.0);
  REQUIRE(places.size() == 2);
  const auto drawn = [&](int tracker, int station) {
    return places[static_cast<std::size_t>(tracker)]
        .tracker_to_drawing(d.trackers[static_cast<std::size_t>(tracker)].stations[static_cast<std::size_t>(station - 1)].in_tracker.origin)
        .z();
  };
  for (int station = 5; station > 1; --station) CHECK(drawn(0, station) < drawn(0, station - 1));
  for (int station = 1; station < 5; ++station) CHECK(drawn(1, station) < drawn(1, station + 1));
  CHECK(std::abs(drawn(0, 5)) < 1e-9);
  CHECK(std::abs(drawn(1, 1) - drawn(0, 1) - 450.0) < 1e-9);
}

TEST_CASE("a tracker is turned, not mirrored", "[geometry]") {
  for (const scifi::placed_along_beam& p : scifi::along_beam(scifi::mice::trackers(), 100.0)) {
    const scifi::vector<double, 3> o = p.tracker_to_drawing({0.0, 0.0, 0.0});
    const auto axis = [&](int i) -> scifi::vector<double, 3> { return p.tracker_to_drawing(scifi::vector<double, 3>::Unit(i)) - o; };
    const scifi::vector<double, 3> x = axis(0), y = axis(1), z = axis(2);
    CHECK((x.cross(y) - z).norm() < 1e-12);
    CHECK(std::abs(x.norm() - 1.0) < 1e-12);
    CHECK(std::abs(y.norm() - 1.0) < 1e-12);
    CHECK(std::abs(x.dot(y)) < 1e-12);
  }
}

TEST_CASE("a tracker without stations takes no place", "[geometry]") {
  scifi::detector d;
  d.trackers.resize(1);
  CHECK(scifi::along_beam(d, 100.0).empty());
}
