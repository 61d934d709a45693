// SPDX-License-Identifier: MPL-2.0
#include <scifi/alignment/track_collector.hpp>

#include <cstddef>
#include <vector>

#include "simulated_tracks.hpp"
#include "support/catch.hpp"

using namespace scifi;
using namespace scifi::alignment;

namespace {

/// Counts of a pass over the same straight tracks, the first one moved far to the side in one station.
tracker_sum pass(const track_cuts& cuts, double field = 0.0) {
  const tracker_parameters parameters(test::tracker_of_mice(mice::downstream), {});
  test::tracks_of_chain tracks(parameters, field, cuts);
  tracker_sum first(parameters.size()), second(parameters.size());
  std::vector<event> events = test::crossing_tracks(parameters.where(), field, 30, 5);
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (i == 0) std::erase_if(events[i].digits, [](const digit& d) { return d.id.station == 3 && d.id.plane == 1; });
    if (i == 1 && field == 0.0)  // two channels are 3 mm
      for (digit& d : events[i].digits)
        if (d.id.station == 3 && d.id.plane != 0) d.id.channel += d.id.plane == 1 ? 2 : -2;
    tracks.reconstruct(events[i]);
    tracks.collect(events[i], i < 15 ? first : second);
    for (track& t : events[i].tracks) t.tracker = 0;
    tracks.collect(events[i], first);  // not this tracker's
  }
  first += second;
  return first;
}

}  // namespace

TEST_CASE("tracks are taken by their planes and their chi2, and what is left out is counted", "[alignment]") {
  const tracker_sum all = pass({.min_planes = 0});
  CHECK(all.equations.tracks() == 30);
  CHECK(all.scale.size() == 30);
  CHECK(all.incomplete + all.improbable + all.failed + all.unbent == 0);
  const tracker_sum complete = pass({.min_planes = 15});
  CHECK(complete.equations.tracks() == 29);
  CHECK(complete.incomplete == 1);
  const tracker_sum probable = pass({.min_planes = 15, .chi2_scale = 0.5});
  CHECK(probable.improbable == 1);
  CHECK(probable.equations.tracks() == 28);
  CHECK(pass({.min_planes = 15, .chi2_scale = 1e6}).improbable == 0);
}

TEST_CASE("helices that hardly bend are left out", "[alignment]") {
  const double field = 3.0 * units::tesla;
  const tracker_sum all = pass({.min_planes = 0, .max_curvature_error = 10.0}, field);
  const tracker_sum bent = pass({.min_planes = 0, .max_curvature_error = 0.02}, field);
  CHECK(all.unbent == 0);
  CHECK(bent.unbent > 0);
  CHECK(bent.unbent + bent.equations.tracks() == all.equations.tracks());
}
