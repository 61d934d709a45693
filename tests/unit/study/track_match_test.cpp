// SPDX-License-Identifier: MPL-2.0
#include <vector>

#include "support/catch.hpp"
#include "support/flown_particle.hpp"

#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/study/track_match.hpp>

using namespace scifi;
using namespace scifi::study;
using test::five;

namespace {

struct event_of_particles {
  detector d = mice::trackers();
  std::vector<crossing> crossings;
  std::vector<track> tracks;

  void fly(const vector<double, 5>& start) {
    for (const crossing& c : test::flown_particle(*d.find(1), static_cast<int>(crossings.size()), start, 3.0 * units::tesla)) crossings.push_back(c);
  }
  void fit(const vector<double, 5>& state) { tracks.push_back(test::fitted_track(1, state, five(1, 1, 1, 1, 1))); }
  [[nodiscard]] track_match matched() const {
    const auto particles = true_tracks(*d.find(1), crossings);
    std::vector<const track*> pointers;
    for (const track& t : tracks) pointers.push_back(&t);
    return match(particles, pointers);
  }
};

}  // namespace

TEST_CASE("two particles near each other each get the nearer track", "[study]") {
  event_of_particles e;
  e.fly(five(0, 0, 30, 0, 200));
  e.fly(five(3, 0, 30, 0, 200));
  e.fit(five(2.5, 0, 30, 0, 200));
  e.fit(five(1.6, 0, 30, 0, 200));
  // The first track is 0.5 mm from the second particle; the other is nearer to it too (1.4 mm), but then takes the one that is left.
  CHECK(e.matched().track_of == std::vector<int>{1, 0});
  CHECK(e.matched().kind_of == std::vector<track_kind>{track_kind::matched, track_kind::matched});
}

TEST_CASE("the windows in position and momentum", "[study]") {
  for (const auto& [off, found] : {std::pair{five(5.9, 0, 0, 0, 0), true}, std::pair{five(6.1, 0, 0, 0, 0), false}, std::pair{five(0, 0, 20, 14, 0), true},
                                   std::pair{five(0, 0, 20, 16, 0), false}, std::pair{five(0, 0, 0, 0, 80), true}}) {
    event_of_particles e;
    e.fly(five(0, 0, 30, 0, 200));
    e.fit(five(0, 0, 30, 0, 200) + off);
    CHECK((e.matched().track_of[0] == 0) == found);
    CHECK((e.matched().kind_of[0] == track_kind::ghost) == !found);
  }
}

TEST_CASE("a second track of one particle is a duplicate, one of none a ghost", "[study]") {
  event_of_particles e;
  e.fly(five(0, 0, 30, 0, 200));
  e.fit(five(1.0, 0, 30, 0, 200));
  e.fit(five(0.2, 0, 30, 0, 200));
  e.fit(five(40, 0, 30, 0, 200));
  CHECK(e.matched().track_of == std::vector<int>{1});
  CHECK(e.matched().kind_of == std::vector<track_kind>{track_kind::duplicate, track_kind::matched, track_kind::ghost});
}

TEST_CASE("a line is matched by its position alone", "[study]") {
  event_of_particles e;
  e.fly(five(0, 0, 80, 0, 200));
  e.fit(five(1.0, 0, 0, 0, 200));
  CHECK(e.matched().track_of == std::vector<int>{-1});
  e.tracks[0].shape = track_shape::line;
  CHECK(e.matched().track_of == std::vector<int>{0});
}
