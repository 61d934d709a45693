// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <cmath>

#include <scifi/kalman/iterated.hpp>
#include <scifi/kalman/plain.hpp>

#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

namespace {

/// Distance from the origin.
struct range {
  double z, sigma;
  double value() const { return z; }
  double covariance() const { return sigma * sigma; }
  kalman::projected<double, 1, 2> project(const scifi::vector<double, 2>& x) const {
    const double r = x.norm();
    return {scifi::vector<double, 1>::Constant(r), x.transpose() / r};
  }
};

double cost(const kalman::estimate<double, 2>& prior, const range& m, const Eigen::Vector2d& x) {
  const Eigen::Vector2d d = x - prior.mean;
  const double r = (m.z - x.norm()) / m.sigma;
  return d.dot(prior.covariance.inverse() * d) + r * r;
}

/// The minimum by a grid refined around its best point: no derivatives, nothing shared with the filter.
Eigen::Vector2d brute_force(const kalman::estimate<double, 2>& prior, const range& m) {
  Eigen::Vector2d best = prior.mean;
  for (double width = 8.0; width > 1e-9; width *= 0.5) {
    const Eigen::Vector2d centre = best;
    for (int i = -8; i <= 8; ++i)
      for (int j = -8; j <= 8; ++j) {
        const Eigen::Vector2d x = centre + width / 8.0 * Eigen::Vector2d(i, j);
        if (cost(prior, m, x) < cost(prior, m, best)) best = x;
      }
  }
  return best;
}

const kalman::estimate<double, 2> prior{Eigen::Vector2d(2.0, 1.0), Eigen::Vector2d(4.0, 1.0).asDiagonal().toDenseMatrix()};
const range strong{4.0, 0.05};

}  // namespace

TEST_CASE("the iterated update finds the minimum that a single linearisation misses", "[kalman]") {
  const Eigen::Vector2d minimum = brute_force(prior, strong);
  const auto once = kalman::joseph{}(prior, strong);
  const auto u = kalman::iterated{kalman::joseph{}, 50, 1e-9}(prior, strong);
  REQUIRE(u.status.ok());
  const double single = (once.posterior.mean - minimum).norm(), many = (u.posterior.mean - minimum).norm();
  CHECK(many < 1e-6);
  CHECK(single > 1e-2);
  CHECK(cost(prior, strong, u.posterior.mean) < cost(prior, strong, once.posterior.mean));
}

TEST_CASE("chi2 of the iterated update is the cost at the minimum", "[kalman]") {
  const auto u = kalman::iterated{kalman::plain{}, 50, 1e-9}(prior, strong);
  CHECK(u.chi2 == Approx(cost(prior, strong, brute_force(prior, strong))).epsilon(1e-7));
}

TEST_CASE("a linear measurement is taken in one iteration and an impossible limit is reported", "[kalman]") {
  const auto linear = kalman::iterated{kalman::joseph{}, 1}(prior, models::position{3.0, 0.1});
  CHECK(linear.status.ok());
  CHECK(linear.posterior.mean == kalman::joseph{}(prior, models::position{3.0, 0.1}).posterior.mean);
  const auto u = kalman::iterated{kalman::joseph{}, 2, 1e-12}(prior, strong);
  CHECK(u.status == kalman::status{kalman::step_kind::update, kalman::reason::not_converged});
  CHECK(u.posterior.mean == prior.mean);
}
