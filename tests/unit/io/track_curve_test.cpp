// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/track_curve.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <scifi/core/units.hpp>

#include "support/catch.hpp"

namespace {

constexpr double field = 3.0 * scifi::units::tesla;
constexpr double pz = 150.0;
constexpr double pt = 40.0;

/// A circle about (12, -7) mm: a positive particle in a field along +z turns clockwise, by field/pz a mm, at radius pt/field (Jackson 12.2).
scifi::track_point on_circle(double z) {
  const double phase = 0.7 - field / pz * z;
  const double radius = pt / field;
  scifi::track_point p;
  p.z = z;
  p.smoothed.mean << 12.0 + radius * std::cos(phase), pt / pz * std::sin(phase), -7.0 + radius * std::sin(phase), -pt / pz * std::cos(phase), 1.0 / pz;
  return p;
}

}  // namespace

TEST_CASE("the curve of a helix stays on its circle, turning evenly", "[io]") {
  std::vector<scifi::track_point> points;
  for (const double z : {0.0, 200.0, 450.0, 750.0, 1100.0}) points.push_back(on_circle(z));
  const auto curve = scifi::track_curve(points, field, 0.05);
  // The largest gap turns by 350 field/pz = 2.1 rad.
  CHECK(static_cast<double>(curve.size()) > 1100.0 * field / pz / 0.05);
  double last = -1.0;
  for (const auto& at : curve) {
    const auto expected = on_circle(at.z()).smoothed.mean;
    CHECK(std::abs(at.x() - expected[scifi::slope_state::x]) < 1e-9);
    CHECK(std::abs(at.y() - expected[scifi::slope_state::y]) < 1e-9);
    CHECK(at.z() > last);
    last = at.z();
  }
}

TEST_CASE("a curve goes through the fitted positions, also where the helices of neighbours differ", "[io]") {
  std::vector<scifi::track_point> points{on_circle(0.0), on_circle(300.0)};
  points[1].smoothed.mean[scifi::slope_state::x] += 5.0;
  points[1].smoothed.mean[scifi::slope_state::ty] -= 0.05;
  const auto curve = scifi::track_curve(points, field);
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    const auto& at = i == 0 ? curve.front() : curve.back();
    CHECK(at.x() == points[i].smoothed.mean[scifi::slope_state::x]);
    CHECK(at.y() == points[i].smoothed.mean[scifi::slope_state::y]);
    CHECK(at.z() == points[i].z);
  }
  for (std::size_t i = 1; i < curve.size(); ++i) CHECK((curve[i] - curve[i - 1]).norm() < 0.2 * 300.0);
}

TEST_CASE("without a field the points are joined by straight pieces", "[io]") {
  std::vector<scifi::track_point> points{on_circle(0.0), on_circle(300.0), on_circle(500.0)};
  CHECK(scifi::track_curve(points, 0.0).size() == 3);
  CHECK(scifi::track_curve({}, field).empty());
}

TEST_CASE("an absurd curvature or none that is finite does not make the curve long", "[io]") {
  for (const double k : {1e300, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    std::vector<scifi::track_point> points{on_circle(0.0), on_circle(300.0)};
    points[0].smoothed.mean[scifi::slope_state::q_over_pz] = k;
    CHECK(scifi::track_curve(points, field).size() <= 257);
  }
}
