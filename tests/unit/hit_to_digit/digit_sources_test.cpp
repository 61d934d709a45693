// SPDX-License-Identifier: MPL-2.0
#include <scifi/hit_to_digit/digit_sources.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("a digit finds its hits in the order in which they were made, and a noise digit none", "[hit_to_digit]") {
  const auto made = [](int particle, int channel) {
    hit h;
    h.particle = particle;
    h.id = {1, 1, 0, channel};
    return h;
  };
  const digit_sources sources({made(1, 30), made(1, 12), made(2, 30), made(3, 31), made(4, 30)});
  const auto found = sources.of({1, 1, 0, 30});
  REQUIRE(found.size() == 3);
  CHECK(found[0].particle == 1);
  CHECK(found[1].particle == 2);
  CHECK(found[2].particle == 4);
  CHECK(sources.of({1, 1, 0, 12}).size() == 1);
  CHECK(sources.of({1, 1, 0, 13}).empty());
  CHECK(sources.of({0, 1, 0, 30}).empty());
}
