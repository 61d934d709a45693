// SPDX-License-Identifier: MPL-2.0
#include <cmath>
#include <limits>
#include <vector>

#include "support/catch.hpp"
#include "support/flown_particle.hpp"

#include <scifi/geometry/mice.hpp>
#include <scifi/study/plane_pulls.hpp>

using namespace scifi;
using namespace scifi::study;
using s = slope_state;

TEST_CASE("pulls are those of the plane the point is in; what the truth leaves open is no error of the fit", "[study]") {
  const detector d = mice::trackers();
  const tracker& where = *d.find(1);
  const auto crossings = test::flown_particle(where, 1, test::five(10, 20, 0, 0, 200), 0.0);
  const true_track particle = true_tracks(where, crossings).at(0);
  const auto surfaces = surfaces_along(where, +1);
  const double open = true_state_at(surfaces[4], crossings[4], &crossings[5], 1, surfaces[4].z, 0.0).open[s::tx];
  track_point p;
  p.station = 2;
  p.plane = 1;
  p.z = surfaces[4].z;
  p.smoothed = kalman::uncorrelated(test::five(10.5, 0.004, 19, 0, 0.005), test::five(0.25, std::sqrt(4e-6 + open), 0.5, 0.001, 0.0));
  p.pull = 1.5;
  p.residual = std::numeric_limits<double>::quiet_NaN();
  plane_pulls a(where, 0.0), b(where, 0.0);
  a.add(particle, std::vector{p});
  b.add(particle, std::vector{p});
  a += b;
  REQUIRE(a.planes().size() == 15);
  for (std::size_t i = 0; i < 15; ++i) CHECK(a.planes()[i].measurement.values.size() == (i == 4 ? 2U : 0U));
  const pulls_at_plane& here = a.planes()[4];
  CHECK(here.station == 2);
  CHECK(here.plane == 1);
  CHECK(here.state[s::x].values.values()[0] == Approx(2.0));
  CHECK(here.state[s::tx].values.values()[0] == Approx(2.0));
  CHECK(here.state[s::y].values.values()[1] == Approx(-2.0));
  CHECK(here.state[s::q_over_pz].values.size() == 0);  // stated as known exactly
  CHECK(here.residual.values.size() == 0);
}
