// SPDX-License-Identifier: MPL-2.0
#include <scifi/track_model/leg.hpp>

#include "support/catch.hpp"

TEST_CASE("a leg starts without length and without material", "[track_model]") {
  const scifi::leg step;
  CHECK(step.dz == 0.0);
  CHECK(step.direction == 1);
  CHECK(step.start.empty());
  CHECK(step.gap.empty());
  CHECK(step.finish.empty());
}

TEST_CASE("a leg holds the slabs of two planes and the gas between them", "[track_model]") {
  const scifi::slab one = scifi::whole(scifi::materials::polystyrene, 0.3);
  scifi::leg step{-10.0, -1, {}, {}, {}};
  for (int i = 0; i < 4; ++i) {
    step.start.add(one);
    step.finish.add(one);
  }
  step.gap.add(scifi::whole(scifi::materials::helium, 8.0));
  CHECK(scifi::thickness(step.start) + scifi::thickness(step.gap) + scifi::thickness(step.finish) == Approx(10.4));
}
