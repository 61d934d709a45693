// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include <scifi/kalman/relinearised.hpp>
#include <scifi/kalman/site.hpp>

namespace kalman = scifi::kalman;

namespace {

using number = scifi::vector<double, 1>;

number one(double x) { return number::Constant(x); }

/// x' = x + t sin(x) with a little noise, observed through its cube.
struct wave {
  kalman::propagated<double, 1> propagate(const number& x, double t) const {
    return {one(x(0) + t * std::sin(x(0))), scifi::matrix<double, 1, 1>::Constant(1.0 + t * std::cos(x(0)))};
  }
  double covariance(double) const { return 0.01; }
};
struct cube {
  double z;
  double value() const { return z; }
  double covariance() const { return 0.04; }
  kalman::projected<double, 1, 1> project(const number& x) const { return {one(x(0) * x(0) * x(0)), scifi::matrix<double, 1, 1>::Constant(3.0 * x(0) * x(0))}; }
};

/// Start of 0.8 +- 0.3, steps of 0.5, measured 2.5 and 5.
double cost(const Eigen::Vector3d& x) {
  const double z[] = {2.5, 5.0};
  double sum = std::pow((x(0) - 0.8) / 0.3, 2);
  for (int k = 0; k < 2; ++k) sum += std::pow(x(k + 1) - x(k) - 0.5 * std::sin(x(k)), 2) / 0.01 + std::pow(z[k] - std::pow(x(k + 1), 3), 2) / 0.04;
  return sum;
}

/// The minimum by comparing costs on a shrinking grid.
Eigen::Vector3d brute_force() {
  Eigen::Vector3d best(0.8, 1.2, 1.6);
  for (double width = 0.3; width > 1e-10; width *= 0.7)
    for (int trial = 0; trial < 60; ++trial)
      for (int i = 0; i < 27; ++i) {
        const Eigen::Vector3d next = best + width * Eigen::Vector3d(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
        if (cost(next) < cost(best)) best = next;
      }
  return best;
}

}  // namespace

TEST_CASE("relinearised passes end at the minimum of the cost over all states, the start included", "[kalman]") {
  const Eigen::Vector3d minimum = brute_force();
  const auto start = kalman::uncorrelated(0.8, 0.3);
  const std::vector<kalman::site<double, cube>> sites{{0.5, {2.5}}, {0.5, {5.0}}};
  std::vector<kalman::node<double, 1, 1>> nodes(2);
  std::vector<number> references(3);
  const kalman::filter f{wave{}, wave{}};
  REQUIRE(kalman::run_relinearised(f, start, start.mean, sites, nodes, references, 1).status.ok());
  const double one_pass = std::abs(nodes[0].smoothed.mean(0) - minimum(1));
  const auto result = kalman::run_relinearised(f, start, start.mean, sites, nodes, references, 60);
  REQUIRE(result.status.ok());
  CHECK(std::abs(references[0](0) - minimum(0)) < 1e-6);
  CHECK(std::abs(nodes[0].smoothed.mean(0) - minimum(1)) < 1e-6);
  CHECK(std::abs(nodes[1].smoothed.mean(0) - minimum(2)) < 1e-6);
  CHECK(one_pass > 1e-3);
  CHECK(result.chi2 == Approx(cost(minimum)).epsilon(1e-6));
}

TEST_CASE("where there is no first step the start is the first site", "[kalman]") {
  const auto start = kalman::uncorrelated(1.2, 0.3);
  const std::vector<kalman::site<std::optional<double>, cube>> sites{{kalman::at_start, {2.5}}, {0.5, {5.0}}};
  std::vector<kalman::node<double, 1, 1>> nodes(2);
  std::vector<number> references(3);
  REQUIRE(kalman::run_relinearised(kalman::filter{wave{}, wave{}}, start, start.mean, sites, nodes, references, 20).status.ok());
  CHECK(references[0](0) == Approx(nodes[0].smoothed.mean(0)).epsilon(1e-9));
}
