// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <limits>

#include <scifi/kalman/symmetric.hpp>

#include "unit/kalman/models.hpp"

namespace detail = scifi::kalman::detail;

TEST_CASE("f p f' + q is symmetric to the last bit and equals Eigen's product", "[kalman]") {
  std::mt19937_64 engine(1);
  for (int trial = 0; trial < 100; ++trial) {
    const auto p = models::random_covariance<5>(engine);
    const auto q = models::random_covariance<4>(engine);
    const auto f = models::random_matrix<4, 5>(engine);
    const scifi::matrix<double, 4, 4> ours = detail::similarity<double, 4, 5>(f, p, q);
    const Eigen::Matrix4d reference = f * p * f.transpose() + q;
    CHECK(ours == Eigen::Matrix4d(ours.transpose()));
    // 50 products of order |f|^2 |p|, each rounded once.
    CHECK((ours - reference).norm() <= 50.0 * std::numeric_limits<double>::epsilon() * (f.squaredNorm() * p.norm() + q.norm()));
    CHECK(detail::transposed<double, 4, 5>(f) == f.transpose());
  }
}
