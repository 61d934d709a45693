// SPDX-License-Identifier: MPL-2.0
#include <scifi/space_point_to_candidate/station_scattering.hpp>

#include <cmath>

#include <scifi/geometry/mice.hpp>
#include <scifi/track_model/material_noise.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

const tracker where = mice::trackers().trackers[mice::downstream];

/// Slab by slab, with the momentum and path as they are: mean of the variances of the two slopes.
double slab_by_slab(const station& s, double p, double tx, double ty) {
  const double path = std::sqrt(1.0 + tx * tx + ty * ty);
  double angle = 0.0;
  for (const plane& q : s.planes) {
    for (const slab& x : q.below) angle += highland_scattering{}.variance(p, muon_plus, x, path);
    for (const slab& x : q.above) angle += highland_scattering{}.variance(p, muon_plus, x, path);
  }
  return 0.5 * slope_covariance(tx, ty, angle).trace();
}

}  // namespace

TEST_CASE("a station scatters as its slabs do, at any momentum and slope", "[space_point_to_candidate]") {
  const station_scattering table(where, muon_plus, highland_scattering{});
  for (std::size_t i = 0; i < where.stations.size(); ++i) {
    CHECK(table.slope_variance(i, 200.0, 0.0) == Approx(slab_by_slab(where.stations[i], 200.0, 0.0, 0.0)).epsilon(1e-12));
    for (const double p : {100.0, 140.0, 300.0})
      for (const double tx : {0.0, 0.2, 0.45}) {
        INFO("p " << p << ", slope " << tx);
        // The logarithm is that of 200 MeV/c and normal incidence.
        CHECK(table.slope_variance(i, p, tx * tx + 0.01) == Approx(slab_by_slab(where.stations[i], p, tx, 0.1)).epsilon(0.06));
      }
  }
}

TEST_CASE("nothing scatters where the policy says so", "[space_point_to_candidate]") {
  const station_scattering table(where, muon_plus, no_scattering{});
  CHECK(table.slope_variance(2, 150.0, 0.1) == 0.0);
}

TEST_CASE("along z the variance is a factor of the momentum times one of the station", "[space_point_to_candidate]") {
  const station_scattering table(where, muon_plus, highland_scattering{});
  for (const double p : {50.0, 120.0, 200.0, 1000.0})
    for (std::size_t i = 0; i < where.stations.size(); ++i) CHECK(table.of_momentum(1.0 / p) * table.of_station(i) == Approx(table.slope_variance(i, p, 0.0)).epsilon(1e-12));
  CHECK(table.mass2() == Approx(square(muon_plus.mass)));
}
