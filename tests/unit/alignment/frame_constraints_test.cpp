// SPDX-License-Identifier: MPL-2.0
#include <scifi/alignment/frame_constraints.hpp>

#include <array>
#include <cmath>
#include <vector>

#include <scifi/core/random.hpp>
#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"

using namespace scifi;
using namespace scifi::alignment;

namespace {

double value_of(const std::vector<coefficient>& row, const Eigen::VectorXd& values) {
  double sum = 0.0;
  for (const coefficient& c : row) sum += c.value * values[c.parameter];
  return sum;
}

const tracker tracker_of_mice = mice::trackers().trackers[mice::downstream];

/// Equations of straight tracks through ideal planes of 0.4 mm, without scattering.
normal_equations of_straight_tracks(const tracker_parameters& parameters, double slopes) {
  random_stream random(11, 0, 0);
  normal_equations sum(parameters.size());
  local_elimination eliminate;
  reduced_track out;
  for (int i = 0; i < 200; ++i) {
    const double x = random.uniform(-80.0, 80.0), y = random.uniform(-80.0, 80.0), tx = slopes * random.normal(), ty = slopes * random.normal();
    track_equations track;
    track.clear(4);
    for (const surface& s : surfaces_along(parameters.where(), 1)) {
      const std::array<double, 4> local{s.cos_angle, s.sin_angle, s.cos_angle * s.z, s.sin_angle * s.z};
      const motion_derivatives global = parameters.derivatives(s, x + tx * s.z, y + ty * s.z);
      track.add(0.4 * random.normal(), 0.4, local, {global.begin(), global.size()});
    }
    eliminate(track, parameters.size(), out);
    sum.add(out);
  }
  return sum;
}

}  // namespace

TEST_CASE("planes that move as their station does have its motion", "[alignment]") {
  const tracker_parameters parameters(tracker_of_mice, {level::planes, true, true, {}});
  Eigen::VectorXd values = Eigen::VectorXd::Zero(parameters.size());
  for (int i = 0; i < parameters.size(); ++i) {
    const tracker_parameter& p = parameters[i];
    const double angle = tracker_of_mice.stations[2].planes[static_cast<std::size_t>(p.plane)].angle;
    if (p.station == 3) values[i] = p.how == motion::rotation ? 0.004 : 0.3 * std::cos(angle) - 0.2 * std::sin(angle);
  }
  CHECK(value_of(station_motion(parameters, 3, motion::x), values) == Approx(0.3));
  CHECK(value_of(station_motion(parameters, 3, motion::y), values) == Approx(-0.2));
  CHECK(value_of(station_motion(parameters, 3, motion::rotation), values) == Approx(0.004));
  CHECK(value_of(station_motion(parameters, 2, motion::x), values) == 0.0);
}

TEST_CASE("a station of parallel strips has a motion across them only", "[alignment]") {
  tracker strips = tracker_of_mice;
  for (station& s : strips.stations) {
    s.planes.resize(1);
    s.planes[0].angle = 0.0;
  }
  const tracker_parameters parameters(strips, {level::planes, true, false, {}});
  const Eigen::VectorXd values = Eigen::VectorXd::Constant(5, 0.7);
  CHECK(value_of(station_motion(parameters, 1, motion::x), values) == Approx(0.7));
  CHECK(std::abs(value_of(station_motion(parameters, 1, motion::y), values)) <= 1e-15);
}

TEST_CASE("straight tracks leave five motions of the whole tracker open, twist too where they are parallel; either frame closes them", "[alignment]") {
  for (const level of : {level::stations, level::planes}) {
    const tracker_parameters parameters(tracker_of_mice, {of, true, true, {}});
    const solution open = solve(of_straight_tracks(parameters, 0.05), frame_constraints(parameters, frame::none));
    CHECK(open.status == failure::undetermined_parameters);
    CHECK(open.undetermined == 5);
    CHECK(solve(of_straight_tracks(parameters, 0.0), {}).undetermined == 6);
    for (const frame keep : {frame::ends, frame::average}) {
      const std::vector<constraint> constraints = frame_constraints(parameters, keep);
      CHECK(constraints.size() == 6);
      const solution closed = solve(of_straight_tracks(parameters, 0.0), constraints);
      REQUIRE(closed.status == failure::none);
      for (const constraint& c : constraints) CHECK(std::abs(value_of(c.coefficients, closed.values)) <= 1e-9);
      // Free planes: only the frame is fixed, chi2 does not pull at the constraints. (The planes of a station, 1.3 mm apart, see a little of a shear.)
      if (of == level::planes) CHECK(closed.multipliers.norm() <= 1e-6);
    }
  }
}

TEST_CASE("what every station shares and what grows with z is what the average keeps", "[alignment]") {
  const tracker_parameters parameters(tracker_of_mice, {});
  const std::vector<constraint> constraints = frame_constraints(parameters, frame::average);
  Eigen::VectorXd bowed = Eigen::VectorXd::Zero(parameters.size());
  bowed[parameters.find(3, -1, motion::x)] = 1.0;
  CHECK(value_of(constraints[0].coefficients, bowed) == Approx(1.0));
  const double middle = (200.8936 + 449.8990 + 749.8284 + 1099.9026) / 5.0;
  CHECK(value_of(constraints[1].coefficients, bowed) == Approx(449.8990 - middle));
}

TEST_CASE("what is held or not free needs no constraint", "[alignment]") {
  CHECK(frame_constraints(tracker_parameters(tracker_of_mice, {level::stations, true, true, {1, 5}}), frame::ends).empty());
  CHECK(frame_constraints(tracker_parameters(tracker_of_mice, {level::stations, false, true, {}}), frame::ends).size() == 2);
  CHECK(frame_constraints(tracker_parameters(tracker_of_mice, {level::stations, true, false, {}}), frame::average).size() == 4);
}
