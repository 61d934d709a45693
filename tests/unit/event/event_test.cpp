// SPDX-License-Identifier: MPL-2.0
#include <scifi/event/event.hpp>

#include <utility>

#include "support/catch.hpp"

namespace {

scifi::event full() {
  scifi::event e;
  e.number = 12;
  e.digits.resize(30);
  e.clusters.resize(15);
  e.space_points.resize(5);
  e.candidates.resize(1);
  e.tracks.resize(1);
  e.track_points.resize(15);
  e.flags.combinations_limited = true;
  return e;
}

}  // namespace

TEST_CASE("clearing an event empties it and keeps its memory", "[event]") {
  scifi::event e = full();
  const auto digits = e.digits.capacity();
  const auto points = e.track_points.capacity();
  e.clear();
  CHECK(e.digits.empty());
  CHECK(e.clusters.empty());
  CHECK(e.space_points.empty());
  CHECK(e.candidates.empty());
  CHECK(e.tracks.empty());
  CHECK(e.track_points.empty());
  CHECK(e.flags == scifi::event_flags{});
  CHECK(e.digits.capacity() == digits);
  CHECK(e.track_points.capacity() == points);
}

TEST_CASE("clearing the reconstruction keeps what the detector said", "[event]") {
  scifi::event e = full();
  clear_reconstruction(e);
  CHECK(e.number == 12);
  CHECK(e.digits.size() == 30);
  CHECK(e.clusters.empty());
  CHECK(e.space_points.empty());
  CHECK(e.candidates.empty());
  CHECK(e.tracks.empty());
  CHECK(e.track_points.empty());
  CHECK(e.flags == scifi::event_flags{});
}

TEST_CASE("an event is a value: a copy is its own", "[event]") {
  const scifi::event e = full();
  scifi::event copy = e;
  copy.clusters[0].channel = 7.0;
  copy.clear();
  CHECK(e.clusters.size() == 15);
  CHECK(e.clusters[0].channel == 0.0);
  const scifi::event moved = std::move(copy);
  CHECK(moved.digits.empty());
}

TEST_CASE("flags start down and compare by value", "[event]") {
  scifi::event_flags a;
  CHECK_FALSE(a.combinations_limited);
  CHECK_FALSE(a.fit_failed);
  scifi::event_flags b;
  b.fit_failed = true;
  CHECK_FALSE(a == b);
}
