// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/track_writer.hpp>

#include <algorithm>
#include <limits>
#include <string>

#include "support/catch.hpp"

namespace {

scifi::event event_with_tracks() {
  scifi::event e;
  e.number = 12;
  scifi::track good;
  good.tracker = 1;
  good.charge = -1;
  good.stations = 5;
  good.planes = 15;
  good.chi2 = 10.5;
  good.ndf = 10;
  good.p_value = 0.3977;
  good.z = 0.0;
  good.reference.mean << 1.25, -2.5, 10.0, -20.0, 200.0;
  good.reference.covariance.setZero();
  good.reference.covariance.diagonal() << 0.09, 0.16, 1.0, 4.0, -1.0;
  good.first_point = 1;
  good.points = 2;
  scifi::track failed = good;
  failed.status = {scifi::kalman::step_kind::update, scifi::kalman::reason::not_finite};
  failed.first_point = 0;
  failed.points = 1;
  scifi::track straight = good;
  straight.shape = scifi::track_shape::line;
  straight.points = 0;
  e.tracks = {failed, good, straight};
  e.clusters.resize(1);
  e.clusters[0].channel = 106.5;
  e.track_points.resize(3);
  for (auto& p : e.track_points) {
    p.station = 2;
    p.plane = 1;
    p.z = 200.25;
    p.smoothed.mean << 1.0, 0.125, 2.0, -0.25, 0.005;
    p.smoothed.covariance.setZero();
    p.smoothed.covariance.diagonal() << 0.01, 1e-6, 0.04, 4e-6, 1e-10;
    p.residual = p.pull = std::numeric_limits<double>::quiet_NaN();
  }
  e.track_points[2].cluster = 0;
  e.track_points[2].residual = -0.1;
  e.track_points[2].pull = -0.25;
  e.track_points[2].chi2 = 0.0625;
  e.track_points[2].outlier = true;
  return e;
}

}  // namespace

TEST_CASE("a row a track: state and errors at the reference surface, by index, without the failed ones", "[io]") {
  std::string out;
  scifi::append_tracks(out, event_with_tracks());
  CHECK(out ==
        "12,1,1,helix,-1,5,15,10.50000,10,0.3977000,1.25000,-2.50000,0.00000,10.00000,-20.00000,200.00000,0.30000,0.40000,1.00000,2.00000,nan\n"
        "12,1,2,line,-1,5,15,10.50000,10,0.3977000,1.25000,-2.50000,0.00000,10.00000,-20.00000,200.00000,0.30000,0.40000,1.00000,2.00000,nan\n");
}

TEST_CASE("a row a track point: positions before slopes, and nan where there is no cluster", "[io]") {
  std::string out;
  scifi::append_track_points(out, event_with_tracks());
  CHECK(out ==
        "12,1,1,2,1,200.25000,1.00000,2.00000,0.12500000,-0.25000000,0.00500000000,0.10000,0.20000,0.00100000,0.00200000,0.00001000000,"
        "nan,nan,nan,0.00000,0\n"
        "12,1,1,2,1,200.25000,1.00000,2.00000,0.12500000,-0.25000000,0.00500000000,0.10000,0.20000,0.00100000,0.00200000,0.00001000000,"
        "106.5,-0.10000,-0.25000,0.06250,1\n");
}

TEST_CASE("rows have as many fields as their header", "[io]") {
  const auto commas = [](std::string_view line) { return std::count(line.begin(), line.end(), ','); };
  std::string tracks, points;
  scifi::append_tracks(tracks, event_with_tracks());
  scifi::append_track_points(points, event_with_tracks());
  CHECK(commas(tracks.substr(0, tracks.find('\n'))) == commas(scifi::track_columns));
  CHECK(commas(points.substr(0, points.find('\n'))) == commas(scifi::track_point_columns));
}
