// SPDX-License-Identifier: MPL-2.0
#include <scifi/candidate_to_track/fit_stops.hpp>

#include <array>

#include <scifi/geometry/mice.hpp>
#include <scifi/track_model/slope_state.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("stops hold what each lane's candidate has at each surface", "[candidate_to_track]") {
  const detector both = mice::trackers();
  const fit_path path = fit_path_of(both.trackers.front());
  std::vector<cluster> clusters;
  space_point point;
  for (int plane = 0; plane < 3; ++plane) {
    cluster hit;
    hit.station = 2;
    hit.plane = plane;
    hit.alpha = 10.0 + plane;
    hit.variance = 0.2;
    point.clusters.push_back(plane);
    clusters.push_back(hit);
  }
  space_point two = point;  // without the last plane
  two.clusters.pop_back();
  const std::array points{point, two};
  candidate of_three, of_two;
  of_three.space_points.push_back(0);
  of_two.space_points.push_back(1);
  using numbers = pack<double, 2>;
  const std::array<fit_job, 2> jobs{{{&of_three, 0, points, clusters}, {&of_two, 1, points, clusters}}};
  fit_memory<slope_state, numbers, leg> work;
  set_stops(path, path.legs, jobs, work);
  REQUIRE(work.stops.size() == path.surfaces.size() + 1);
  CHECK_FALSE(work.stops.front().step);
  for (std::size_t i = 1; i < work.stops.size(); ++i) CHECK(&work.stops[i].step->get() == &path.legs[i]);
  for (std::size_t i = 0; i < path.surfaces.size(); ++i) {
    const surface& at = path.surfaces[i];
    REQUIRE(work.stops[i].measurement.has_value() == (at.station == 2));
    if (at.station != 2) continue;
    const auto& seen = *work.stops[i].measurement;
    CHECK(seen.where[0]);
    CHECK(seen.where[1] == (at.plane < 2));
    CHECK(seen.alpha[0] == 10.0 + at.plane);
    CHECK(seen.alpha_variance[0] == 0.2);
    CHECK(seen.cos_angle == at.cos_angle);
    CHECK(work.cluster_at[i] == at.plane);
    CHECK(work.cluster_at[path.surfaces.size() + i] == (at.plane < 2 ? at.plane : -1));
  }
  CHECK_FALSE(work.stops.back().measurement);
}
