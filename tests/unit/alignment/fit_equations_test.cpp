// SPDX-License-Identifier: MPL-2.0
#include <scifi/alignment/fit_equations.hpp>

#include <algorithm>
#include <cmath>

#include <scifi/alignment/local_elimination.hpp>

#include "simulated_tracks.hpp"
#include "support/catch.hpp"

using namespace scifi;
using namespace scifi::alignment;

namespace {

/// Sums of chi2 of tracks, as the filter found them and as the equations have them.
struct compared {
  int tracks = 0;
  double largest = 0.0;  // difference
  bool same_ndf = true;
};

compared compare(int id, double field) {
  const tracker_parameters parameters(test::tracker_of_mice(id), {});
  test::tracks_of_chain tracks(parameters, field);
  track_equations track_rows;
  local_elimination eliminate;
  reduced_track reduced;
  compared out;
  for (event& e : test::crossing_tracks(parameters.where(), field, 40, 3)) {
    tracks.reconstruct(e);
    for (const track& t : e.tracks) {
      REQUIRE(tracks.equations(e, t, track_rows) == failure::none);
      eliminate(track_rows, parameters.size(), reduced);
      REQUIRE(reduced.status == failure::none);
      out.largest = std::max(out.largest, std::abs(reduced.chi2 - t.chi2));
      out.same_ndf = out.same_ndf && reduced.ndf == t.ndf;
      ++out.tracks;
    }
  }
  return out;
}

}  // namespace

TEST_CASE("the equations of a straight track have the chi2 of its filter", "[alignment]") {
  for (const int id : {mice::upstream, mice::downstream}) {
    const compared c = compare(id, 0.0);
    CHECK(c.tracks > 20);
    CHECK(c.same_ndf);
    // The filter starts from a prior 50 mm and 0.5 wide about the seed: (0.3/50)^2 and (0.02/0.5)^2.
    CHECK(c.largest <= 5e-3);
  }
}

TEST_CASE("the equations of a helix have the chi2 of its filter", "[alignment]") {
  for (const int id : {mice::upstream, mice::downstream}) {
    const compared c = compare(id, 3.0 * units::tesla);
    CHECK(c.tracks > 20);
    CHECK(c.same_ndf);
    // As above, and the filter was linearised about the seed, or the track of the pass before.
    CHECK(c.largest <= 0.1);
  }
}

TEST_CASE("a track whose fit stopped has no equations", "[alignment]") {
  const tracker_parameters parameters(test::tracker_of_mice(mice::downstream), {});
  test::tracks_of_chain tracks(parameters, 0.0);
  event e = test::crossing_tracks(parameters.where(), 0.0, 1, 3).front();
  tracks.reconstruct(e);
  REQUIRE(e.tracks.size() == 1);
  track_equations rows;
  CHECK(tracks.equations(e, e.tracks[0], rows) == failure::none);
  e.tracks[0].status = {kalman::step_kind::predict, kalman::reason::not_finite};
  CHECK(tracks.equations(e, e.tracks[0], rows) == failure::too_few_measurements);
  e.tracks[0].status = {};
  e.tracks[0].points = 0;
  CHECK(tracks.equations(e, e.tracks[0], rows) == failure::too_few_measurements);
}
