// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <limits>

#include <scifi/kalman/ldl.hpp>

#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

TEST_CASE("L D L' solves from the right and gives the quadratic form of the inverse", "[kalman]") {
  std::mt19937_64 engine(4);
  for (int trial = 0; trial < 50; ++trial) {
    const auto a = models::random_covariance<5>(engine);
    const auto b = models::random_matrix<3, 5>(engine);
    const auto v = models::random_matrix<5, 1>(engine);
    const kalman::ldl<double, 5> factor(a);
    const scifi::matrix<double, 5, 5> inverse = a.inverse();
    const double tolerance = 1e-14 * a.norm() * inverse.norm();
    CHECK(factor.ok());
    CHECK((factor.solve_from_right<3>(b) - b * inverse).norm() < tolerance * (b * inverse).norm());
    CHECK(factor.half_solve(v).cwiseAbs2().dot(factor.inverse_diagonal()) == Approx(v.dot(inverse * v)).epsilon(tolerance));
    scifi::matrix<double, 3, 5> z = b;
    factor.decorrelate<3>(z);
    CHECK((z * factor.inverse_diagonal().asDiagonal() * z.transpose() - b * inverse * b.transpose()).norm() < tolerance * (b * inverse * b.transpose()).norm());
  }
}

TEST_CASE("L D L' refuses what is not positive definite, whatever the scales", "[kalman]") {
  const Eigen::Vector3d v(1.0, 2.0, 3.0);
  CHECK_FALSE(kalman::ldl<double, 3>(v * v.transpose()).ok());
  CHECK_FALSE(kalman::ldl<double, 3>(Eigen::Matrix3d::Zero()).ok());
  CHECK_FALSE(kalman::ldl<double, 3>(Eigen::Vector3d(1.0, 1.0, -1.0).asDiagonal().toDenseMatrix()).ok());
  CHECK_FALSE(kalman::ldl<double, 3>(Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN())).ok());
  CHECK(kalman::ldl<double, 3>(Eigen::Vector3d(1e-20, 1.0, 1e20).asDiagonal().toDenseMatrix()).ok());
}
