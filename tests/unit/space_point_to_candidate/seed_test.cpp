// SPDX-License-Identifier: MPL-2.0
#include <scifi/space_point_to_candidate/seed.hpp>

#include <cmath>
#include <vector>

#include <scifi/core/random.hpp>
#include <scifi/core/units.hpp>
#include <scifi/track_model/helix_propagator.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

constexpr double field = 3.0 * units::tesla;

vector<double, 5> start() {
  vector<double, 5> x;
  x << 10.0, 0.15, -20.0, 0.1, 0.005;
  return x;
}

/// Space points of the exact helix at five stations, smeared.
std::vector<arc_point> points(double sigma, std::uint64_t seed) {
  random_stream random(seed, 0, 0);
  std::vector<arc_point> out;
  for (const double z : {0.0, 200.0, 450.0, 750.0, 1100.0}) {
    const auto at = helix_propagator{field}.propagate(start(), z).state;
    out.push_back({{at[slope_state::x] + sigma * random.normal(), at[slope_state::y] + sigma * random.normal()}, 0.09, z});
  }
  return out;
}

arc_fit fitted(const std::vector<arc_point>& from, double curvature_variance) {
  const arc_prior prior{1.0, start()[slope_state::q_over_pz] * field, curvature_variance, {0.15, 0.1}};
  double w = prior.curvature;
  for (int i = 0;; ++i) {
    arc_fit fit(from[0], prior, w);
    for (std::size_t k = 1; k < from.size(); ++k) {
      fit.fly(from[k].z, 0.0);
      fit.take(from[k]);
    }
    if (i == 6) return fit;
    w += fit.curvature_step();
  }
}

}  // namespace

TEST_CASE("the seed of a helix is its state at the last point", "[space_point_to_candidate]") {
  const auto truth = helix_propagator{field}.propagate(start(), 1100.0).state;
  const auto seed = seed_of_helix(fitted(points(0.0, 1), 1.0), field);
  for (int i = 0; i < 5; ++i) CHECK(seed.mean[i] == Approx(truth[i]).epsilon(1e-5).margin(1e-7));
  CHECK((seed.covariance - seed.covariance.transpose()).norm() < 1e-12 * seed.covariance.norm());
}

TEST_CASE("the seed of a line keeps the q/pz that it is given, without an error", "[space_point_to_candidate]") {
  const arc_fit fit = fitted(points(0.0, 1), 0.0);
  const auto seed = seed_of_line(fit, -0.004);
  CHECK(seed.mean[slope_state::q_over_pz] == -0.004);
  for (int i = 0; i < 5; ++i) {
    CHECK(seed.covariance(slope_state::q_over_pz, i) == 0.0);
    CHECK(seed.covariance(i, slope_state::q_over_pz) == 0.0);
  }
  CHECK(seed.mean[slope_state::x] == fit.position().x);
  CHECK(seed.covariance(slope_state::x, slope_state::x) == fit.position_variance());
}

TEST_CASE("the covariance of the seed is that of its errors", "[space_point_to_candidate]") {
  const auto truth = helix_propagator{field}.propagate(start(), 1100.0).state;
  constexpr int tracks = 3000;
  matrix<double, 5, 5> sum = matrix<double, 5, 5>::Zero();
  matrix<double, 5, 5> stated = matrix<double, 5, 5>::Zero();
  for (int k = 0; k < tracks; ++k) {
    const auto seed = seed_of_helix(fitted(points(0.3, 100 + static_cast<std::uint64_t>(k)), 1.0), field);
    const vector<double, 5> miss = seed.mean - truth;
    sum += miss * miss.transpose() / tracks;
    stated += seed.covariance / tracks;
  }
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j <= i; ++j) {
      INFO(slope_state::names[static_cast<std::size_t>(i)] << ", " << slope_state::names[static_cast<std::size_t>(j)]);
      // The error of a covariance from n errors, Gaussian: sqrt((c_ii c_jj + c_ij^2)/n).
      const double error = std::sqrt((stated(i, i) * stated(j, j) + stated(i, j) * stated(i, j)) / tracks);
      CHECK(std::abs(sum(i, j) - stated(i, j)) < 5.0 * error);
    }
  }
}
