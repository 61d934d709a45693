// SPDX-License-Identifier: MPL-2.0
#include <scifi/event/raw_digit.hpp>

#include "support/catch.hpp"

TEST_CASE("the reconstruction sees the channel and the light of a digit, not its counts", "[event]") {
  const scifi::raw_digit d{{1, 2, 0, 57}, 128, 10.5};
  const scifi::digit seen = d.seen();
  CHECK(seen.id == d.id);
  CHECK(seen.npe == 10.5);
}
