// SPDX-License-Identifier: MPL-2.0
#include <scifi/event/hit.hpp>

#include <type_traits>

#include "support/catch.hpp"

TEST_CASE("a hit starts without energy, at rest, and copies as a value", "[event]") {
  scifi::hit h;
  CHECK(h.edep == 0.0);
  CHECK(h.momentum.norm() == 0.0);
  scifi::hit other = h;
  other.id.channel = 5;
  other.position.x() = 1.0;
  CHECK(h.id.channel == 0);
  CHECK(h.position.x() == 0.0);
  CHECK(std::is_trivially_destructible_v<scifi::hit>);
}
