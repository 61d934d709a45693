// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <cmath>

#include <scifi/kalman/joseph.hpp>
#include <scifi/kalman/residual.hpp>

#include "laws/update_laws.hpp"
#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

TEST_CASE("removing a measurement undoes its update", "[kalman]") {
  std::mt19937_64 engine(16);
  for (int trial = 0; trial < 50; ++trial) {
    const kalman::estimate<double, 4> prior{models::random_matrix<4, 1>(engine), models::random_covariance<4>(engine)};
    const models::linear_values<4, 2> m{models::random_matrix<2, 1>(engine), models::random_matrix<2, 4>(engine), models::random_covariance<2>(engine)};
    const auto used = kalman::joseph{}(prior, m);
    const auto back = kalman::removed(used.posterior, m);
    REQUIRE(back.status.ok());
    CHECK(laws::estimate_distance(prior, back.posterior) < 1e-8);

    // Before: R + H P H'. After: R - H P+ H'. With the measurement taken out again: the one from before.
    const auto before = kalman::residual_if_unused(prior, m);
    const auto after = kalman::residual_if_used(used.posterior, m);
    const auto without = kalman::without_own_measurement(after, m.r);
    CHECK((before.covariance - used.residual_covariance).norm() < 1e-12 * before.covariance.norm());
    CHECK((without.value - before.value).norm() < 1e-8 * before.value.norm());
    CHECK((without.covariance - before.covariance).norm() < 1e-8 * before.covariance.norm());
    // chi2 is the same before and after (Fruehwirth 1987, section 3.1).
    CHECK(kalman::chi2(before) == Approx(used.chi2).epsilon(1e-10));
    CHECK(kalman::chi2(after) == Approx(used.chi2).epsilon(1e-8));
  }
}

TEST_CASE("the pull divides by the standard deviation and is NaN for a negative variance", "[kalman]") {
  const kalman::residual<double, 2> r{{3.0, 1.0}, Eigen::Vector2d(4.0, -1.0).asDiagonal().toDenseMatrix()};
  CHECK(kalman::pull(r) == 1.5);
  CHECK(std::isnan(kalman::pull(r, 1)));
  CHECK(std::isnan(kalman::chi2(r)));
}

TEST_CASE("whitened components have unit covariance", "[kalman]") {
  std::mt19937_64 engine(17);
  const kalman::residual<double, 3> r{models::random_matrix<3, 1>(engine), models::random_covariance<3>(engine)};
  const auto white = kalman::whitened(r);
  const Eigen::Matrix3d l = r.covariance.llt().matrixL();
  CHECK((l * white - r.value).norm() < 1e-14 * r.value.norm());
  CHECK(white.squaredNorm() == Approx((r.value.transpose() * r.covariance.inverse() * r.value)(0, 0)).epsilon(1e-12));
}

TEST_CASE("a measurement that alone fixes the state cannot be taken out", "[kalman]") {
  const auto vague = kalman::uncorrelated(Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(1e12, 1.0));
  const models::position m{1.0, 1e-3};
  const auto used = kalman::joseph{}(vague, m);
  const auto back = kalman::removed(used.posterior, m);
  CHECK(back.status.why == kalman::reason::singular_innovation);
  CHECK(back.posterior.mean == used.posterior.mean);
}
