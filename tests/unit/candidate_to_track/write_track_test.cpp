// SPDX-License-Identifier: MPL-2.0
#include <scifi/candidate_to_track/write_track.hpp>

#include <cmath>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("an estimate is taken out of its lane", "[candidate_to_track]") {
  using numbers = pack<float, 4>;
  kalman::estimate<numbers, 2> e;
  for (int i = 0; i < 2; ++i) {
    for (int lane = 0; lane < 4; ++lane) {
      e.mean[i].set(lane, static_cast<float>(10 * lane + i));
      for (int j = 0; j < 2; ++j) e.covariance(i, j).set(lane, static_cast<float>(100 * lane + 10 * i + j));
    }
  }
  const kalman::estimate<double, 2> third = lane_of(e, 2);
  CHECK(third.mean == vector<double, 2>(20.0, 21.0));
  CHECK(third.covariance(1, 0) == 210.0);
}

TEST_CASE("a failure keeps whose it was and why, and no points", "[candidate_to_track]") {
  fit_path path;
  path.z_reference = 3.0;
  candidate c;
  c.tracker = 1;
  c.shape = track_shape::line;
  fitted_track out;
  out.points.resize(2);
  const kalman::status why{kalman::step_kind::update, kalman::reason::singular_innovation};
  write_failure(path, {&c, 9, {}, {}}, why, out);
  CHECK(out.points.empty());
  CHECK(out.summary.tracker == 1);
  CHECK(out.summary.candidate == 9);
  CHECK(out.summary.shape == track_shape::line);
  CHECK(out.summary.z == 3.0);
  CHECK(out.summary.status == why);
}

TEST_CASE("a lane that failed is seen in its nodes", "[candidate_to_track]") {
  using numbers = pack<double, 2>;
  kalman::node<numbers, 2, 1> n;
  for (auto* e : {&n.predicted, &n.filtered, &n.smoothed}) *e = {vector<numbers, 2>::Constant(numbers(1.0)), matrix<numbers, 2, 2>::Identity()};
  CHECK(detail::fault_in_lane(n, 0).ok());
  n.filtered.covariance(1, 1).set(1, -1.0);
  CHECK(detail::fault_in_lane(n, 0).ok());
  CHECK(detail::fault_in_lane(n, 1).why == kalman::reason::not_positive_definite);
  n.predicted.mean[0].set(0, std::nan(""));
  CHECK(detail::fault_in_lane(n, 0).why == kalman::reason::not_finite);
}
