// SPDX-License-Identifier: MPL-2.0
#include <scifi/kalman/correction.hpp>

#include <random>

#include "support/catch.hpp"
#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

namespace {

/// Moves the mean and leaves the covariance, whatever the gain.
struct half_a_policy {
  double variance;
  template <class Scalar, int N, int M>
  void correct(const kalman::estimate<Scalar, N>& prior, const kalman::detail::innovation_view<Scalar, N, M>&, const kalman::gain<Scalar, N, M>& k, kalman::estimate<Scalar, N>& posterior) const {
    k.move(prior.mean, posterior.mean);
    posterior.covariance = variance * prior.covariance;
  }
};

}  // namespace

TEST_CASE("a correction records what was compared and judges the posterior that its policy wrote", "[kalman]") {
  std::mt19937_64 engine(3);
  const kalman::estimate<double, 4> prior{models::random_matrix<4, 1>(engine), models::random_covariance<4>(engine)};
  const models::linear_values<4, 2> m{models::random_matrix<2, 1>(engine), models::random_matrix<2, 4>(engine), models::random_covariance<2>(engine)};
  const auto good = kalman::detail::corrected(half_a_policy{0.5}, prior, m);
  CHECK(good.status.ok());
  CHECK(good.jacobian == m.h);
  CHECK(good.measurement_covariance == m.r);
  CHECK((good.residual - (m.z - m.h * prior.mean)).norm() < 1e-14);
  CHECK((good.residual_covariance - (m.h * prior.covariance * m.h.transpose() + m.r)).norm() < 1e-13 * good.residual_covariance.norm());
  CHECK(good.posterior.covariance == 0.5 * prior.covariance);
  const auto bad = kalman::detail::corrected(half_a_policy{-0.5}, prior, m);
  CHECK(bad.status == kalman::status{kalman::step_kind::update, kalman::reason::not_positive_definite});
  CHECK(bad.posterior.mean == prior.mean);
  CHECK(bad.posterior.covariance == prior.covariance);
}
