// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <scifi/kalman/factored_estimate.hpp>

#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

TEST_CASE("an estimate survives being factored and multiplied out", "[kalman]") {
  std::mt19937_64 engine(9);
  for (int trial = 0; trial < 50; ++trial) {
    const kalman::estimate<double, 5> e{models::random_matrix<5, 1>(engine), models::random_covariance<5>(engine)};
    const auto f = kalman::factored(e);
    CHECK(f.factor.isLowerTriangular(0.0));
    CHECK(f.mean == e.mean);
    CHECK((kalman::unfactored(f).covariance - e.covariance).norm() < 1e-14 * e.covariance.norm());
    CHECK(f.covariance() == f.covariance().transpose());
    CHECK(&kalman::unfactored(e) == &e);
  }
}
