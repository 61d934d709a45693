// SPDX-License-Identifier: MPL-2.0
#include <scifi/hit_to_digit/dead_channels.hpp>

#include <algorithm>
#include <cmath>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("a dead channel is one that was named, however often and in whatever order", "[hit_to_digit]") {
  const dead_channels none;
  CHECK(none.size() == 0);
  CHECK_FALSE(none.contains({0, 1, 0, 5}));
  const dead_channels some({{1, 2, 0, 7}, {0, 1, 0, 5}, {1, 2, 0, 7}});
  CHECK(some.size() == 2);
  CHECK(some.contains({0, 1, 0, 5}));
  CHECK(some.contains({1, 2, 0, 7}));
  for (const channel_id& id : {channel_id{0, 2, 0, 7}, channel_id{1, 1, 0, 7}, channel_id{1, 2, 1, 7}, channel_id{1, 2, 0, 8}}) CHECK_FALSE(some.contains(id));
  CHECK(std::is_sorted(some.begin(), some.end()));
}

TEST_CASE("the drawn share of the channels is dead, the same for the same seed, and more with a larger share", "[hit_to_digit]") {
  const detector trackers = mice::trackers();
  double channels = 0.0;
  for (const tracker& t : trackers.trackers)
    for (const station& s : t.stations)
      for (const plane& p : s.planes) channels += p.channels;
  CHECK(drawn_dead_channels(trackers, 0.0, 1).size() == 0);
  CHECK(static_cast<double>(drawn_dead_channels(trackers, 1.0, 1).size()) == channels);

  const dead_channels few = drawn_dead_channels(trackers, 0.02, 7);
  // Binomial: four standard deviations.
  CHECK(std::abs(static_cast<double>(few.size()) - 0.02 * channels) < 4.0 * std::sqrt(0.02 * 0.98 * channels));
  const dead_channels again = drawn_dead_channels(trackers, 0.02, 7);
  CHECK(std::equal(few.begin(), few.end(), again.begin(), again.end()));
  const dead_channels other = drawn_dead_channels(trackers, 0.02, 8);
  CHECK_FALSE(std::equal(few.begin(), few.end(), other.begin(), other.end()));
  const dead_channels more = drawn_dead_channels(trackers, 0.05, 7);
  CHECK(more.size() > few.size());
  CHECK(std::all_of(few.begin(), few.end(), [&more](const channel_id& id) { return more.contains(id); }));
  for (const channel_id& id : few) CHECK(trackers.find_plane(id)->has_channel(id.channel));
}
