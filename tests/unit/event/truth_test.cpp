// SPDX-License-Identifier: MPL-2.0
#include <scifi/event/truth.hpp>

#include "support/catch.hpp"

TEST_CASE("clearing the truth of an event empties it and keeps its memory", "[event]") {
  scifi::truth t;
  t.crossings.resize(15);
  t.hits.resize(30);
  t.particles.resize(3);
  t.last_particle = 3;
  const auto crossings = t.crossings.capacity();
  const auto hits = t.hits.capacity();
  t.clear();
  CHECK(t.crossings.empty());
  CHECK(t.hits.empty());
  CHECK(t.particles.empty());
  CHECK(t.last_particle == 0);
  CHECK(t.crossings.capacity() == crossings);
  CHECK(t.hits.capacity() == hits);
}
