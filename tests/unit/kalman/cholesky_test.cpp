// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <limits>

#include <scifi/kalman/cholesky.hpp>

#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

TEST_CASE("the Cholesky factor and its solutions are those of Eigen", "[kalman]") {
  std::mt19937_64 engine(2);
  for (int trial = 0; trial < 100; ++trial) {
    const auto a = models::random_covariance<6>(engine);
    const auto b = models::random_matrix<6, 2>(engine);
    const kalman::cholesky<double, 6> ours(a);
    const Eigen::LLT<scifi::matrix<double, 6, 6>> reference(a);
    REQUIRE(ours.ok());
    // Condition number of at most |a| / 0.1.
    const double tolerance = 1e3 * std::numeric_limits<double>::epsilon() * a.norm() / 0.1;
    CHECK((ours.lower() - scifi::matrix<double, 6, 6>(reference.matrixL())).norm() < tolerance * a.norm());
    CHECK((ours.solve<2>(b) - reference.solve(b)).norm() < tolerance * b.norm() / 0.1);
    CHECK((ours.lower() * ours.half_solve<2>(b) - b).norm() < tolerance * b.norm());
  }
}

TEST_CASE("a matrix that is singular, indefinite or not finite is refused", "[kalman]") {
  const Eigen::Vector3d v(1.0, 1.0 / 3.0, 0.7);
  CHECK_FALSE(kalman::cholesky<double, 3>(v * v.transpose()).ok());
  CHECK_FALSE(kalman::cholesky<double, 3>(Eigen::Matrix3d::Zero()).ok());
  CHECK_FALSE(kalman::cholesky<double, 3>(Eigen::Vector3d(1.0, 1.0, -1.0).asDiagonal().toDenseMatrix()).ok());
  CHECK_FALSE(kalman::cholesky<double, 3>(Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN())).ok());
  // Badly scaled is not badly conditioned.
  CHECK(kalman::cholesky<double, 3>(Eigen::Vector3d(1e-20, 1.0, 1e20).asDiagonal().toDenseMatrix()).ok());
}

TEST_CASE("a semidefinite matrix of any rank equals the square of its factor", "[kalman]") {
  std::mt19937_64 engine(3);
  for (int trial = 0; trial < 100; ++trial) {
    const auto two = models::random_matrix<4, 2>(engine);
    const Eigen::Matrix4d a = two * two.transpose();
    const auto lower = kalman::semidefinite_factor<double, 4>(a);
    // A dropped pivot of 4 eps changes an entry by its root.
    CHECK((lower * lower.transpose() - a).norm() < 1e-13 * a.norm() / std::min(1.0, a.topLeftCorner<2, 2>().determinant()));
    CHECK(lower.isLowerTriangular());
  }
  CHECK(kalman::semidefinite_factor<double, 3>(Eigen::Matrix3d::Zero()).isZero(0.0));
}
