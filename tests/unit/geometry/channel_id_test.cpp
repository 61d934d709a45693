// SPDX-License-Identifier: MPL-2.0
#include <scifi/geometry/channel_id.hpp>

#include <set>

#include "support/catch.hpp"

using scifi::channel_id;

TEST_CASE("a channel id is written as tracker, station, plane and three digits of channel", "[geometry]") {
  CHECK(scifi::tspc({1, 1, 0, 57}) == 110057);
  CHECK(scifi::tspc({0, 5, 2, 211}) == 52211);
  static_assert(scifi::tspc({0, 1, 0, 0}) == 10000);
}

TEST_CASE("every channel of two trackers has its own number and comes back from it", "[geometry]") {
  std::set<int> seen;
  for (int t = 0; t < 2; ++t)
    for (int s = 1; s <= 9; ++s)
      for (int p = 0; p < 10; ++p)
        for (int c = 0; c < 1000; c += c % 7 + 1) {
          const channel_id id{t, s, p, c};
          if (scifi::channel_from_tspc(scifi::tspc(id)) != id) FAIL("lost " << scifi::tspc(id));
          if (!seen.insert(scifi::tspc(id)).second) FAIL("twice " << scifi::tspc(id));
        }
  CHECK(scifi::channel_from_tspc(110057) == channel_id{1, 1, 0, 57});
}

TEST_CASE("ids sort by tracker, then station, then plane, then channel, as their numbers do", "[geometry]") {
  const channel_id ids[] = {{0, 1, 0, 999}, {0, 1, 1, 0}, {0, 2, 0, 0}, {1, 1, 0, 0}};
  for (int i = 0; i + 1 < 4; ++i) {
    CHECK(ids[i] < ids[i + 1]);
    CHECK(scifi::tspc(ids[i]) < scifi::tspc(ids[i + 1]));
  }
}
