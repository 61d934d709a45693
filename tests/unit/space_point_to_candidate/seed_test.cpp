// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include <scifi/core/units.hpp>
#include <scifi/space_point_to_candidate/seed.hpp>
#include <scifi/track_model/helix_propagator.hpp>

using namespace scifi;
using s = slope_state;

namespace {

const double field = 3.0 * units::tesla;

/// An arc fit through four points of an exact helix.
arc_fit fitted(const vector<double, 5>& start, double curvature_variance) {
  const helix_propagator helix{field};
  const double w = field * start[s::q_over_pz];
  const auto point = [&](double z) {
    const auto x = helix.propagate(start, z).state;
    return arc_point{{x[s::x], x[s::y]}, 0.12, z};
  };
  arc_prior prior;
  prior.curvature = w;
  prior.curvature_variance = curvature_variance;
  arc_fit fit(point(0.0), prior, w);
  for (const double z : {200.0, 450.0, 750.0}) {
    fit.fly(z, 1e-6);
    fit.take(point(z));
  }
  return fit;
}

}  // namespace

TEST_CASE("the seed of an exact helix is the helix", "[space_point_to_candidate]") {
  vector<double, 5> start;
  start << 10.0, 0.15, -20.0, 0.08, 1.0 / 190.0;
  const auto seed = seed_of_helix(fitted(start, 1e-6), field);
  const vector<double, 5> expected = helix_propagator{field}.propagate(start, 750.0).state;
  // The prior pulls the slope towards zero by the ratio of the variances, about 1e-5.
  for (int i = 0; i < 5; ++i) CHECK(seed.mean[i] == Approx(expected[i]).epsilon(1e-4).margin(1e-6));
}

TEST_CASE("the covariance of a seed is symmetric and positive definite, and turning the points turns it", "[space_point_to_candidate]") {
  vector<double, 5> start;
  start << 10.0, 0.15, -20.0, 0.08, 1.0 / 190.0;
  const auto seed = seed_of_helix(fitted(start, 1e-6), field);
  CHECK((seed.covariance - seed.covariance.transpose()).norm() == Approx(0.0).margin(1e-15));
  CHECK(Eigen::LLT<matrix<double, 5, 5>>(seed.covariance).info() == Eigen::Success);

  // A quarter turn about z: x -> y, y -> -x.
  vector<double, 5> turned;
  turned << 20.0, -0.08, 10.0, 0.15, 1.0 / 190.0;
  const auto other = seed_of_helix(fitted(turned, 1e-6), field);
  CHECK(other.covariance(s::y, s::y) == Approx(seed.covariance(s::x, s::x)).epsilon(1e-9));
  CHECK(other.covariance(s::x, s::ty) == Approx(-seed.covariance(s::y, s::tx)).epsilon(1e-9));
  CHECK(other.covariance(s::y, s::tx) == Approx(-seed.covariance(s::x, s::ty)).epsilon(1e-9));
}

TEST_CASE("a line's seed takes q/pz as given", "[space_point_to_candidate]") {
  vector<double, 5> start;
  start << 10.0, 0.15, -20.0, 0.08, 1e-12;
  const auto seed = seed_of_line(fitted(start, 0.0), -0.005);
  CHECK(seed.mean[s::q_over_pz] == -0.005);
  CHECK(seed.covariance(s::q_over_pz, s::q_over_pz) == 0.0);
  CHECK(seed.mean[s::x] == Approx(10.0 + 750.0 * 0.15).epsilon(1e-4));
}
