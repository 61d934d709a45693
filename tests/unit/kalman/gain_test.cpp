// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <cmath>
#include <limits>

#include <scifi/kalman/gain.hpp>

#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

namespace {

template <int N, int M>
void check_against_inverse(std::mt19937_64& engine) {
  const auto p = models::random_covariance<N>(engine);
  const kalman::innovation<double, N, M> seen{models::random_matrix<M, 1>(engine), models::random_matrix<M, N>(engine), models::random_covariance<M>(engine)};
  const auto k = kalman::optimal_gain(p, seen);
  const Eigen::MatrixXd s = seen.jacobian * p * seen.jacobian.transpose() + seen.covariance;
  const Eigen::MatrixXd inverse = s.inverse();
  const double tolerance = 1e-13 * s.norm() * inverse.norm();
  CHECK(k.why == kalman::reason::none);
  CHECK((k.residual_covariance - s).norm() < 1e-13 * s.norm());
  CHECK((k.weight() - p * seen.jacobian.transpose() * inverse).norm() < tolerance * (1.0 + k.weight().norm()));
  const scifi::vector<double, N> x = models::random_matrix<N, 1>(engine);
  scifi::vector<double, N> moved;
  k.move(x, moved);
  CHECK((moved - x - p * seen.jacobian.transpose() * inverse * seen.residual).norm() < tolerance * (1.0 + k.weight().norm()) * (1.0 + seen.residual.norm() + x.norm()));
  CHECK(k.chi2 == Approx((seen.residual.transpose() * inverse * seen.residual)(0, 0)).epsilon(tolerance));
}

}  // namespace

TEST_CASE("the gain is P H' times the inverse of S", "[kalman]") {
  std::mt19937_64 engine(5);
  for (int trial = 0; trial < 20; ++trial) {
    check_against_inverse<1, 1>(engine);
    check_against_inverse<5, 1>(engine);
    check_against_inverse<5, 2>(engine);
    check_against_inverse<6, 3>(engine);
  }
}

TEST_CASE("a residual covariance that cannot be inverted is named", "[kalman]") {
  const Eigen::Matrix2d p = Eigen::Vector2d(1.0, 0.0).asDiagonal();
  const kalman::innovation<double, 2, 1> exact{scifi::vector<double, 1>::Constant(1.0), {0.0, 1.0}, scifi::matrix<double, 1, 1>::Zero()};
  CHECK(kalman::optimal_gain(p, exact).why == kalman::reason::singular_innovation);
  CHECK(std::isnan(kalman::optimal_gain(p, exact).chi2));
  const kalman::innovation<double, 2, 2> twice{{1.0, 1.0}, Eigen::Matrix2d::Ones(), Eigen::Matrix2d::Zero()};
  CHECK(kalman::optimal_gain(p, twice).why == kalman::reason::singular_innovation);
  const Eigen::Matrix2d nan = Eigen::Matrix2d::Constant(std::numeric_limits<double>::quiet_NaN());
  CHECK(kalman::optimal_gain(nan, exact).why == kalman::reason::not_finite);
  CHECK(kalman::optimal_gain(nan, twice).why == kalman::reason::not_finite);
}

TEST_CASE("a measurement with a negative variance is refused though the residual's is positive", "[kalman]") {
  const Eigen::Matrix2d p = Eigen::Vector2d(4.0, 9.0).asDiagonal();
  const kalman::innovation<double, 2, 1> negative{scifi::vector<double, 1>::Constant(1.0), {1.0, 0.0}, scifi::matrix<double, 1, 1>::Constant(-1.0)};
  CHECK(kalman::optimal_gain(p, negative).residual_covariance(0, 0) == 3.0);
  CHECK(kalman::optimal_gain(p, negative).why == kalman::reason::not_positive_definite);
  CHECK(std::isnan(kalman::optimal_gain(p, negative).chi2));
  const Eigen::Matrix2d second = Eigen::Vector2d(1.0, -1.0).asDiagonal();
  const kalman::innovation<double, 2, 2> both{{1.0, 1.0}, Eigen::Matrix2d::Identity(), second};
  CHECK(kalman::optimal_gain(p, both).why == kalman::reason::not_positive_definite);
  const kalman::innovation<double, 2, 1> none{scifi::vector<double, 1>::Constant(1.0), {1.0, 0.0}, scifi::matrix<double, 1, 1>::Zero()};
  CHECK(kalman::optimal_gain(p, none).why == kalman::reason::none);
}
