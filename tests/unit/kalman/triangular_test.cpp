// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <limits>

#include <scifi/kalman/triangular.hpp>

#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

TEST_CASE("the triangular factor has the product of the matrix with its transpose", "[kalman]") {
  std::mt19937_64 engine(4);
  for (int trial = 0; trial < 100; ++trial) {
    const auto a = models::random_matrix<4, 9>(engine);
    const auto lower = kalman::lower_triangular<double, 4, 9>(a);
    CHECK(lower.isLowerTriangular(0.0));
    CHECK(lower.diagonal().minCoeff() >= 0.0);
    CHECK((lower * lower.transpose() - a * a.transpose()).norm() < 100.0 * std::numeric_limits<double>::epsilon() * a.squaredNorm());
    // Unique but for signs, which we fix: the same as the transposed R of Eigen's QR.
    const Eigen::Matrix<double, 9, 4> transposed = a.transpose();
    Eigen::Matrix4d r = Eigen::HouseholderQR<Eigen::Matrix<double, 9, 4>>(transposed).matrixQR().topRows<4>().triangularView<Eigen::Upper>();
    for (int i = 0; i < 4; ++i)
      if (r(i, i) < 0.0) r.row(i) *= -1.0;
    CHECK((lower - r.transpose()).norm() < 1e-12 * a.norm() * a.norm() / r.diagonal().minCoeff());
  }
}

TEST_CASE("rows of zeros and dependent rows are triangularised too", "[kalman]") {
  Eigen::Matrix<double, 3, 4> a;
  a << 0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 2.0, 4.0, 6.0, 8.0;
  const auto lower = kalman::lower_triangular<double, 3, 4>(a);
  CHECK((lower * lower.transpose() - a * a.transpose()).norm() < 1e-13);
  CHECK(lower.allFinite());
}
