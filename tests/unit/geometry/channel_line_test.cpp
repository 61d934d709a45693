// SPDX-License-Identifier: MPL-2.0
#include <scifi/geometry/channel_line.hpp>

#include <cmath>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"

TEST_CASE("the line of a channel has its alpha all along, lies in its plane and ends at the edge of the active area", "[geometry]") {
  scifi::tracker t = scifi::mice::trackers().trackers.front();
  t.stations[2].in_tracker.angle = 0.02;
  for (const scifi::station& s : t.stations) {
    const auto& o = s.in_tracker.origin;
    for (const scifi::plane& p : s.planes) {
      for (const double channel : {0.0, 57.0, 106.5, 200.0}) {
        const scifi::line_segment line = scifi::line_of_channel(s, p, channel, t.active_radius);
        const double angle = p.angle + s.in_tracker.angle;
        for (const auto& end : {line.from, line.to}) {
          const double alpha = (end.x() - o.x()) * std::cos(angle) + (end.y() - o.y()) * std::sin(angle);
          CHECK(std::abs(alpha - (p.central_channel - channel) * p.channel_width) < 1e-10);
          CHECK(std::abs(std::hypot(end.x() - o.x(), end.y() - o.y()) - t.active_radius) < 1e-10);
          CHECK(std::abs(end.z() - o.z() - p.z_measured) < 1e-12);
        }
        CHECK((line.to - line.from).norm() > 10.0);
      }
    }
  }
}

TEST_CASE("a channel beyond the active area has a line of no length", "[geometry]") {
  const scifi::station s = scifi::mice::fibre_station(1, {0.0, 0.0, 0.0});
  const scifi::line_segment line = scifi::line_of_channel(s, s.planes[2], 0.0, 100.0);
  CHECK((line.to - line.from).norm() == 0.0);
  CHECK(std::isfinite(line.from.x()));
}
