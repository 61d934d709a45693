// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/joseph.hpp>

#include "laws/update_laws.hpp"
#include "unit/kalman/ill_conditioned.hpp"
#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

TEST_CASE("Joseph's form equals the information form, P^-1 + H' R^-1 H", "[kalman]") {
  std::mt19937_64 engine(6);
  for (int trial = 0; trial < 100; ++trial) {
    const kalman::estimate<double, 4> prior{models::random_matrix<4, 1>(engine), models::random_covariance<4>(engine)};
    const models::linear_values<4, 2> m{models::random_matrix<2, 1>(engine), models::random_matrix<2, 4>(engine), models::random_covariance<2>(engine)};
    const auto u = kalman::joseph{}(prior, m);
    REQUIRE(u.status.ok());
    const Eigen::Matrix4d information = prior.covariance.inverse() + m.h.transpose() * m.r.inverse() * m.h;
    const Eigen::Matrix4d covariance = information.inverse();
    const Eigen::Vector4d mean = covariance * (prior.covariance.inverse() * prior.mean + m.h.transpose() * m.r.inverse() * m.z);
    CHECK(laws::estimate_distance(u.posterior, kalman::estimate<double, 4>{mean, covariance}) < 1e-9);
    CHECK(u.posterior.covariance == u.posterior.covariance.transpose());
  }
}

TEST_CASE("independent linear measurements may come in any order", "[kalman]") {
  std::mt19937_64 engine(7);
  for (int trial = 0; trial < 100; ++trial) {
    const kalman::estimate<double, 4> prior{models::random_matrix<4, 1>(engine), models::random_covariance<4>(engine)};
    const models::linear_values<4, 2> a{models::random_matrix<2, 1>(engine), models::random_matrix<2, 4>(engine), models::random_covariance<2>(engine)};
    const models::linear_values<4, 1> b{models::random_matrix<1, 1>(engine), models::random_matrix<1, 4>(engine), models::random_covariance<1>(engine)};
    CHECK(laws::order_dependence(kalman::joseph{}, prior, a, b) < 1e-10);
  }
}

TEST_CASE("a measurement of enormous covariance changes nothing", "[kalman]") {
  const auto prior = kalman::uncorrelated(Eigen::Vector2d(1.0, 2.0), Eigen::Vector2d(3.0, 4.0));
  const auto u = kalman::joseph{}(prior, models::position{1e3, 1e12});
  CHECK(laws::estimate_distance(prior, u.posterior) < 1e-15);
  CHECK(u.chi2 < 1e-15);
}

TEST_CASE("Joseph's form stays symmetric and positive definite over a million ill-conditioned steps", "[kalman]") {
  const auto found = ill_conditioned::drive<double>(kalman::joseph{}, 1'000'000);
  CHECK(found.failed == 0);
  CHECK(found.not_symmetric == 0);
  CHECK(found.not_positive_definite == 0);
}

TEST_CASE("Joseph's form stays positive definite in single precision too", "[kalman]") {
  const auto found = ill_conditioned::drive<float>(kalman::joseph{}, 100'000);
  CHECK(found.failed == 0);
  CHECK(found.not_symmetric == 0);
  CHECK(found.not_positive_definite == 0);
}
