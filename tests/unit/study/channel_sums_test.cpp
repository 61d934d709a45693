// SPDX-License-Identifier: MPL-2.0
#include <cmath>
#include <vector>

#include "support/catch.hpp"

#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/study/channel_sums.hpp>

using namespace scifi;
using namespace scifi::study;

namespace {

cluster in_plane(int station, int plane, double channel) {
  cluster c;
  c.tracker = 1;
  c.station = station;
  c.plane = plane;
  c.channel = channel;
  return c;
}

}  // namespace

TEST_CASE("the expected sum of the surveyed trackers is 318.5 in every station", "[study]") {
  // 106.5 + 106.5 + 105.5, the central channels of the three views.
  const detector d = mice::trackers();
  const channel_sums sums(*d.find(1));
  REQUIRE(sums.stations().size() == 5);
  for (const station_channel_sums& s : sums.stations()) CHECK(s.expected == 318.5);
}

TEST_CASE("channels that one point lights sum to the constant within rounding, wherever the point is", "[study]") {
  const detector d = mice::trackers();
  channel_sums sums(*d.find(1));
  int points = 0;
  for (double x = -90.0; x <= 90.0; x += 17.3) {
    for (double y = -90.0; y <= 90.0; y += 13.9) {
      std::vector<cluster> clusters;
      const double angles[] = {120.0, -120.0, 0.0};
      const double central[] = {106.5, 106.5, 105.5};
      for (int p = 0; p < 3; ++p) {
        const double a = angles[p] * units::degree;
        clusters.push_back(in_plane(2, p, std::round(central[p] - (x * std::cos(a) + y * std::sin(a)) / 1.4945)));
      }
      sums.add(clusters);
      ++points;
    }
  }
  const auto& of = sums.stations()[1].difference;
  CHECK(of.values.size() == static_cast<std::size_t>(points));
  for (const double off : of.values.values()) CHECK(std::abs(off) <= 1.5);  // three roundings of half a channel
}

TEST_CASE("every triplet within reach counts, once; stations are told apart; merged", "[study]") {
  const detector d = mice::trackers();
  channel_sums a(*d.find(1)), b(*d.find(1));
  a.add(std::vector{in_plane(1, 0, 100), in_plane(1, 0, 104), in_plane(1, 1, 100), in_plane(1, 2, 118), in_plane(1, 2, 150), in_plane(2, 0, 106)});
  b.add(std::vector{in_plane(1, 0, 100), in_plane(1, 1, 100), in_plane(1, 2, 118.5)});
  a += b;
  const auto values = a.stations()[0].difference.values.sorted();
  REQUIRE(values.size() == 3);
  CHECK(values[0] == -0.5);
  CHECK(values[1] == 0.0);
  CHECK(values[2] == 3.5);
  CHECK(a.stations()[0].difference.histogram.at(24) == 1.0);  // the bin about zero
  CHECK(a.stations()[1].difference.values.size() == 0);
}
