// SPDX-License-Identifier: MPL-2.0
#include <scifi/alignment/tracker_parameters.hpp>

#include <cmath>
#include <stdexcept>
#include <string>

#include <scifi/core/random.hpp>
#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"

using namespace scifi;
using namespace scifi::alignment;

namespace {

/// A tracker without symmetry.
tracker tilted() {
  tracker t = mice::trackers().trackers[mice::downstream];
  for (station& s : t.stations) s.in_tracker.angle = 0.1 * s.id;
  return t;
}

/// The channel, not rounded, that a point of the tracker frame lights, by placements alone.
double channel_of(const tracker& t, const surface& at, double x, double y) {
  for (const station& s : t.stations) {
    if (s.id != at.station) continue;
    const plane& p = s.planes[static_cast<std::size_t>(at.plane)];
    const vector<double, 3> in_plane = p.in_station().parent_to_child(s.in_tracker.parent_to_child({x, y, at.z}));
    return p.channel_at(in_plane.x());
  }
  throw std::logic_error("no such station");
}

}  // namespace

TEST_CASE("derivatives are those of the channel that is lit when the tracker is moved", "[alignment]") {
  const tracker t = tilted();
  for (const level of : {level::stations, level::planes}) {
    const tracker_parameters parameters(t, {of, true, true, {}});
    CHECK(parameters.size() == (of == level::stations ? 15 : 30));
    random_stream random(1, 0, 0);
    for (const surface& at : surfaces_along(t, 1)) {
      const double x = random.uniform(-100.0, 100.0), y = random.uniform(-100.0, 100.0);
      Eigen::VectorXd derivative = Eigen::VectorXd::Zero(parameters.size());
      for (const coefficient& c : parameters.derivatives(at, x, y)) derivative[c.parameter] += c.value;
      for (int i = 0; i < parameters.size(); ++i) {
        // The channel falls as alpha grows; a plane that moved by u has its channels there.
        constexpr double step = 1e-5;
        Eigen::VectorXd up = Eigen::VectorXd::Zero(parameters.size());
        up[i] = step;
        const double width = t.stations.front().planes.front().channel_width;
        const double slope = -width * (channel_of(parameters.moved(up), at, x, y) - channel_of(parameters.moved(-up), at, x, y)) / (2.0 * step);
        // Rounding 1e-13/step; a rotation bends by step^2 times 100 mm.
        CHECK(derivative[i] == Approx(slope).margin(1e-6));
      }
    }
  }
}

TEST_CASE("what is not free does not move", "[alignment]") {
  const tracker t = tilted();
  const tracker_parameters held(t, {level::stations, true, true, {1, 5}});
  CHECK(held.size() == 9);
  const tracker moved = held.moved(Eigen::VectorXd::Ones(9));
  CHECK(moved.stations[0].in_tracker.origin == t.stations[0].in_tracker.origin);
  CHECK(moved.stations[4].in_tracker.angle == t.stations[4].in_tracker.angle);
  CHECK(moved.stations[2].in_tracker.origin.x() == t.stations[2].in_tracker.origin.x() + 1.0);
  CHECK(moved.stations[2].in_tracker.origin.z() == t.stations[2].in_tracker.origin.z());
  CHECK(held.derivatives(surfaces_along(t, 1).front(), 1.0, 2.0).empty());
  CHECK(tracker_parameters(t, {level::stations, true, false, {}}).size() == 10);
  CHECK(tracker_parameters(t, {level::planes, false, true, {}}).size() == 15);
}

TEST_CASE("parameters have names and units", "[alignment]") {
  const tracker t = tilted();
  const tracker_parameters stations(t, {}), planes(t, {level::planes, true, true, {}});
  CHECK(name_of(stations[0]) == "station 1 x");
  CHECK(name_of(stations[5]) == "station 2 rotation");
  CHECK(name_of(planes[2]) == "station 1 plane 1 along");
  CHECK(std::string(stations[5].unit()) == "rad");
  CHECK(std::string(planes[2].unit()) == "mm");
  CHECK(stations.find(2, -1, motion::rotation) == 5);
  CHECK(stations.find(2, 0, motion::rotation) == -1);
}

TEST_CASE("a wrong choice of what is free is refused", "[alignment]") {
  const tracker t = tilted();
  CHECK_THROWS_WITH(tracker_parameters(t, {level::stations, true, true, {7}}), "there is no station 7 in tracker 1");
  CHECK_THROWS_WITH(tracker_parameters(t, {level::stations, true, true, {1, 2, 3, 4, 5}}), "nothing is free in tracker 1");
  CHECK_THROWS_AS(tracker_parameters(t, {level::stations, false, false, {}}), std::invalid_argument);
}
