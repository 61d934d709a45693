// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <scifi/kalman/joseph.hpp>
#include <scifi/kalman/plain.hpp>

#include "laws/update_laws.hpp"
#include "unit/kalman/ill_conditioned.hpp"
#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

TEST_CASE("the plain form equals the information form where the problem is well conditioned", "[kalman]") {
  std::mt19937_64 engine(8);
  for (int trial = 0; trial < 100; ++trial) {
    const kalman::estimate<double, 3> prior{models::random_matrix<3, 1>(engine), models::random_covariance<3>(engine)};
    const models::linear_values<3, 1> m{models::random_matrix<1, 1>(engine), models::random_matrix<1, 3>(engine), models::random_covariance<1>(engine)};
    const auto u = kalman::plain{}(prior, m);
    const Eigen::Matrix3d covariance = (prior.covariance.inverse() + m.h.transpose() * m.r.inverse() * m.h).inverse();
    const Eigen::Vector3d mean = covariance * (prior.covariance.inverse() * prior.mean + m.h.transpose() * m.r.inverse() * m.z);
    CHECK(laws::estimate_distance(u.posterior, kalman::estimate<double, 3>{mean, covariance}) < 1e-9);
    CHECK(u.chi2 == Approx(kalman::joseph{}(prior, m).chi2).epsilon(1e-13));
  }
}

TEST_CASE("the plain form loses positive definiteness on the ill-conditioned problem", "[kalman]") {
  const auto found = ill_conditioned::drive<double>(kalman::plain{}, 1000);
  CHECK(found.failed + found.not_positive_definite > 0);
}
