// SPDX-License-Identifier: MPL-2.0
#include <scifi/geometry/plane.hpp>

#include <cmath>

#include <scifi/core/units.hpp>

#include "support/catch.hpp"

using scifi::plane;

namespace {

plane strips() {
  plane p;
  p.channels = 10;
  p.central_channel = 4.5;
  p.channel_width = 0.5;
  p.angle = 30.0 * scifi::units::degree;
  p.z_measured = 7.0;
  return p;
}

}  // namespace

TEST_CASE("alpha falls as the channel number grows and is zero at the central channel", "[geometry]") {
  const plane p = strips();
  CHECK(p.alpha(4.5) == 0.0);
  CHECK(p.alpha(0.0) == 2.25);
  CHECK(p.alpha(9.0) == -2.25);
  CHECK(p.alpha(3.0) - p.alpha(4.0) == 0.5);
}

TEST_CASE("channel and alpha are inverse of each other, between and beyond the channels too", "[geometry]") {
  const plane p = strips();
  for (const double channel : {-3.0, 0.0, 1.25, 4.5, 9.0, 40.0}) CHECK(p.channel_at(p.alpha(channel)) == Approx(channel).margin(1e-14));
  for (const double alpha : {-7.0, -0.1, 0.0, 3.3}) CHECK(p.alpha(p.channel_at(alpha)) == Approx(alpha).margin(1e-14));
}

TEST_CASE("a plane knows which channels exist", "[geometry]") {
  const plane p = strips();
  CHECK(p.has_channel(0));
  CHECK(p.has_channel(9));
  CHECK_FALSE(p.has_channel(-1));
  CHECK_FALSE(p.has_channel(10));
}

TEST_CASE("in the plane frame the first coordinate is alpha and the second runs along the strips", "[geometry]") {
  const plane p = strips();
  const double x = 1.2, y = -0.4;
  const scifi::vector<double, 3> inside = p.in_station().parent_to_child({x, y, 7.0});
  const double c = std::sqrt(3.0) / 2.0, s = 0.5;
  CHECK(inside.x() == Approx(x * c + y * s));
  CHECK(inside.y() == Approx(-x * s + y * c));
  CHECK(inside.z() == 0.0);
}
