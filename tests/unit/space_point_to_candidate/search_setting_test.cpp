// SPDX-License-Identifier: MPL-2.0
#include <scifi/space_point_to_candidate/search_setting.hpp>

#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("a setting knows the distances of any three stations of its tracker", "[space_point_to_candidate]") {
  const tracker where = mice::trackers().trackers[mice::upstream];
  track_finder_options o;
  o.field = 3.0 * units::tesla;
  const search_setting setting(where, o, muon_plus, highland_scattering{});
  CHECK(setting.id == where.id);
  CHECK(setting.travel == where.beam_direction);
  REQUIRE(setting.stations.size() == where.stations.size());
  const auto z = [&where](std::size_t i) { return where.stations[i].in_tracker.origin.z(); };
  for (std::size_t third = 2; third < where.stations.size(); ++third)
    for (std::size_t second = 1; second < third; ++second)
      for (std::size_t first = 0; first < second; ++first) {
        const chord_turn& turn = setting.turn(first, second, third);
        // The planes of all stations are stacked alike.
        CHECK(turn.step1() == Approx(z(second) - z(first)));
        CHECK(turn.step2() == Approx(z(third) - z(second)));
        CHECK(turn.largest() <= o.field / o.smallest_pz);
      }
}
