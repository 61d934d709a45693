// SPDX-License-Identifier: MPL-2.0
#include <cmath>
#include <limits>
#include <string>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

#include <scifi/geometry/mice.hpp>
#include <scifi/io/track_point_reader.hpp>
#include <scifi/io/track_writer.hpp>

using namespace scifi;

namespace {

event with_points() {
  event e;
  e.number = 12;
  for (int i = 0; i < 2; ++i) {
    track t;
    t.tracker = 1;
    t.reference.mean << 0, 0, 30, 40, 200;
    t.reference.covariance.setIdentity();
    t.first_point = 3 * i;
    t.points = 3;
    e.tracks.push_back(t);
    for (int p = 0; p < 3; ++p) {
      track_point point;
      point.station = 1 + i;
      point.plane = p;
      point.z = 0.5 + 200.0 * i + p;
      point.smoothed.mean << 1.5, 0.25, -3.0 + p, 0.125, 0.005;
      point.smoothed.covariance = vector<double, 5>(0.25, 0.0625, 0.25, 0.0625, 1e-8).asDiagonal();
      point.residual = p == 1 ? std::numeric_limits<double>::quiet_NaN() : 0.75;
      point.pull = p == 1 ? std::numeric_limits<double>::quiet_NaN() : 1.5;
      point.outlier = p == 1;
      e.track_points.push_back(point);
    }
  }
  return e;
}

}  // namespace

TEST_CASE("points come back to their tracks as they were written", "[io]") {
  const detector d = mice::trackers();
  const event e = with_points();
  std::string text(track_point_columns);
  append_track_points(text, e);
  const test::temporary_folder folder;
  track_point_reader reader(folder.file("points.csv", text), d);
  event back = e;
  for (track& t : back.tracks) t.first_point = t.points = 0;
  CHECK(reader.next_event() == 12);
  reader.read(12, back);
  REQUIRE(back.track_points.size() == 6);
  CHECK(back.tracks[1].first_point == 3);
  CHECK(back.tracks[1].points == 3);
  for (std::size_t i = 0; i < 6; ++i) {
    const track_point& a = e.track_points[i];
    const track_point& b = back.track_points[i];
    CHECK(a.station == b.station);
    CHECK(a.plane == b.plane);
    CHECK(a.z == b.z);
    CHECK(a.smoothed.mean == b.smoothed.mean);
    CHECK(a.smoothed.covariance.isApprox(b.smoothed.covariance));
    CHECK(a.outlier == b.outlier);
    CHECK(std::isnan(a.pull) == std::isnan(b.pull));
    if (!std::isnan(a.pull)) CHECK(a.pull == b.pull);
    if (!std::isnan(a.residual)) CHECK(a.residual == b.residual);
    CHECK(b.cluster == -1);
  }
}

TEST_CASE("a point that belongs nowhere is refused with line and column", "[io]") {
  const detector d = mice::trackers();
  const test::temporary_folder folder;
  const auto message = [&](const std::string& rows) {
    const auto path = folder.file("points.csv", std::string(track_point_columns) + rows);
    return test::without(path.string(), test::message_of<input_error>([&] {
                           event e = with_points();
                           for (track& t : e.tracks) t.first_point = t.points = 0;
                           track_point_reader(path, d).read(12, e);
                         }));
  };
  const std::string tail = ",1,0,0.5,1,2,0.1,0.2,0.005,0.3,0.3,0.01,0.01,0.0001,50,0.1,0.2,0.3,0\n";
  CHECK(message("12,1,0" + tail) == "(no error)");
  CHECK(message("12,1,2" + tail) == ":2: track: there is no track 2 in event 12");
  CHECK(message("12,0,0" + tail) == ":2: tracker: the track is one of tracker 1");
  CHECK(message("12,1,0" + tail + "12,1,1" + tail + "12,1,0" + tail) == ":4: track: the points of a track must stand together");
  CHECK(message("12,1,0,7,0,0.5,1,2,0.1,0.2,0.005,0.3,0.3,0.01,0.01,0.0001,50,0.1,0.2,0.3,0\n") == ":2: plane: there is no plane 0 in station 7 of tracker 1");
  CHECK(message("12,1,0,1,0,0.5,1,inf,0.1,0.2,0.005,0.3,0.3,0.01,0.01,0.0001,50,0.1,0.2,0.3,0\n") == ":2: y_mm: 'inf' is not a finite number");
}
