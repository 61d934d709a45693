// SPDX-License-Identifier: MPL-2.0
#include <scifi/candidate_to_track/fit_memory.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("a track is appended with the place of its points", "[candidate_to_track]") {
  fitted_track one;
  one.summary.candidate = 4;
  one.points.resize(3);
  for (track_point& p : one.points) p.smoothed = {vector<double, 5>::Zero(), matrix<double, 5, 5>::Zero()};
  one.summary.reference = one.points[0].smoothed;
  std::vector<track> tracks;
  std::vector<track_point> points;
  append(one, tracks, points);
  append(one, tracks, points);
  REQUIRE(tracks.size() == 2);
  CHECK(points.size() == 6);
  CHECK(tracks[0].first_point == 0);
  CHECK(tracks[1].first_point == 3);
  CHECK(tracks[1].candidate == 4);
}
