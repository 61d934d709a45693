// SPDX-License-Identifier: MPL-2.0
// Published numbers of examples from textbooks.
#include "support/catch.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <optional>
#include <vector>

#include <scifi/kalman/bryson_frazier.hpp>
#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/site.hpp>
#include <scifi/kalman/smoother.hpp>

#include "reference/nile.hpp"
#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;
namespace nile = reference::nile;

namespace {

/// A level that changes by a random step each year.
struct level {
  double transition(int) const { return 1.0; }
  double covariance(int) const { return nile::change; }
};
struct year {
  double flow;
  double value() const { return flow; }
  double covariance() const { return nile::measured; }
  double projection() const { return 1.0; }
};
using node = kalman::node<double, 1, 1>;

/// The years from `first` on, filtered from what is known of the level in the first of them.
std::vector<node> filtered(const kalman::estimate<double, 1>& start, std::size_t first) {
  std::vector<kalman::site<std::optional<int>, year>> sites;
  for (std::size_t k = first; k < nile::flow.size(); ++k) sites.push_back({k == first ? std::nullopt : std::optional(1), {nile::flow[k]}});
  std::vector<node> nodes(sites.size());
  REQUIRE(kalman::filter{level{}, level{}}.run(start, sites, nodes).status.ok());
  return nodes;
}

/// Logarithm of the probability density of all measurements: that of each given those before.
double log_likelihood(const std::vector<node>& nodes) {
  double sum = 0.0;
  for (const node& n : nodes) sum -= 0.5 * (std::log(2.0 * std::numbers::pi * n.residual_covariance(0, 0)) + n.chi2);
  return sum;
}

/// The acceleration is constant over each step and drawn anew for the next.
struct drawn_acceleration {
  double variance;
  scifi::matrix<double, 2, 2> covariance(double t) const {
    scifi::matrix<double, 2, 2> c;
    c << 0.25 * t * t * t * t, 0.5 * t * t * t, 0.5 * t * t * t, t * t;
    return variance * c;
  }
};

}  // namespace

TEST_CASE("the level of the Nile has the likelihood that is published for it", "[kalman]") {
  REQUIRE(std::accumulate(nile::flow.begin(), nile::flow.end(), 0.0) == 91935.0);
  CHECK(log_likelihood(filtered(kalman::uncorrelated(0.0, std::sqrt(1e7)), 0)) == Approx(nile::vague_start).margin(5e-5));

  // Nothing known before the first year: its flow is the level.
  const auto second_year = kalman::uncorrelated(nile::flow[0], std::sqrt(nile::measured + nile::change));
  CHECK(log_likelihood(filtered(second_year, 1)) == Approx(nile::unknown_start).margin(5e-5));
}

TEST_CASE("the smoothed level of the Nile is the spline that minimises its roughness", "[kalman]") {
  // The mode of all levels solves x_k + (r/q)(2 x_k - x_k-1 - x_k+1) = y_k: a tridiagonal system, by Thomas' elimination.
  const double weight = nile::measured / nile::change;
  const std::size_t n = nile::flow.size();
  std::vector<double> above(n), x(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double diagonal = 1.0 + (k == 0 || k + 1 == n ? 1.0 : 2.0) * weight;
    const double pivot = diagonal + (k == 0 ? 0.0 : weight * above[k - 1]);
    above[k] = -weight / pivot;
    x[k] = (nile::flow[k] + (k == 0 ? 0.0 : weight * x[k - 1])) / pivot;
  }
  for (std::size_t k = n - 1; k-- > 0;) x[k] -= above[k] * x[k + 1];

  auto nodes = filtered(kalman::uncorrelated(nile::flow[0], std::sqrt(nile::measured + nile::change)), 1);
  REQUIRE(kalman::smooth(nodes).ok());
  for (std::size_t k = 1; k < n; ++k) CHECK(nodes[k - 1].smoothed.mean(0) == Approx(x[k]).epsilon(1e-12));
  REQUIRE(kalman::smooth(nodes, kalman::modified_bryson_frazier{}).ok());
  for (std::size_t k = 1; k < n; ++k) CHECK(nodes[k - 1].smoothed.mean(0) == Approx(x[k]).epsilon(1e-12));
}

TEST_CASE("the gain for constant velocity settles at Kalata's alpha and beta", "[kalman]") {
  // Kalata, IEEE Trans. Aerosp. Electron. Syst. 20 (1984) 174: with the tracking index lambda = T^2 sigma_w / sigma_v,
  // r = (4 + lambda - sqrt(8 lambda + lambda^2)) / 4, alpha = 1 - r^2, beta = 2 (2 - alpha) - 4 sqrt(1 - alpha).
  for (const double lambda : {0.01, 0.3, 1.0, 7.0}) {
    INFO("tracking index " << lambda);
    const double t = 0.5, sigma_v = 3.0, sigma_w = lambda * sigma_v / (t * t);
    const kalman::filter f{models::constant_velocity{}, drawn_acceleration{sigma_w * sigma_w}};
    auto p = f.predict(kalman::uncorrelated(Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(10.0, 10.0)), t);
    for (int i = 0; i < 2000; ++i) p = f.predict(f.update(p, models::position{0.0, sigma_v}), t);
    p.estimate.mean.setZero();
    const Eigen::Vector2d gain = f.update(p, models::position{1.0, sigma_v}).posterior.mean;  // of a residual of one
    const double r = (4.0 + lambda - std::sqrt(8.0 * lambda + lambda * lambda)) / 4.0;
    const double alpha = 1.0 - r * r, beta = 2.0 * (2.0 - alpha) - 4.0 * std::sqrt(1.0 - alpha);
    CHECK(gain(0) == Approx(alpha).epsilon(1e-11));
    CHECK(gain(1) * t == Approx(beta).epsilon(1e-11));
  }
}
