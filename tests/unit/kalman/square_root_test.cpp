// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <cmath>

#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/square_root.hpp>

#include "laws/update_laws.hpp"
#include "unit/kalman/ill_conditioned.hpp"
#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

TEST_CASE("the square-root update equals the information form", "[kalman]") {
  std::mt19937_64 engine(10);
  for (int trial = 0; trial < 100; ++trial) {
    const kalman::estimate<double, 4> prior{models::random_matrix<4, 1>(engine), models::random_covariance<4>(engine)};
    const models::linear_values<4, 2> m{models::random_matrix<2, 1>(engine), models::random_matrix<2, 4>(engine), models::random_covariance<2>(engine)};
    const auto u = kalman::square_root{}(prior, m);
    const Eigen::Matrix4d covariance = (prior.covariance.inverse() + m.h.transpose() * m.r.inverse() * m.h).inverse();
    const Eigen::Vector4d mean = covariance * (prior.covariance.inverse() * prior.mean + m.h.transpose() * m.r.inverse() * m.z);
    CHECK(laws::estimate_distance(u.posterior, kalman::estimate<double, 4>{mean, covariance}) < 1e-9);
    const Eigen::Matrix2d s = m.h * prior.covariance * m.h.transpose() + m.r;
    CHECK(u.chi2 == Approx((u.residual.transpose() * s.inverse() * u.residual)(0, 0)).epsilon(1e-10));
    CHECK((u.residual_covariance - s).norm() < 1e-13 * s.norm());
  }
}

TEST_CASE("a factored estimate goes through predictions and updates as the covariance does", "[kalman]") {
  std::mt19937_64 engine(11);
  const kalman::filter with_factor{models::step_transition{}, models::step_noise{}, kalman::square_root{}};
  const kalman::filter with_covariance{models::step_transition{}, models::step_noise{}};
  kalman::estimate<double, 3> e{models::random_matrix<3, 1>(engine), models::random_covariance<3>(engine)};
  auto f = kalman::factored(e);
  for (int i = 0; i < 50; ++i) {
    const models::matrix_step<3> step{0.6 * models::random_matrix<3, 3>(engine), models::random_covariance<3>(engine)};
    const models::linear_values<3, 2> m{models::random_matrix<2, 1>(engine), models::random_matrix<2, 3>(engine), models::random_covariance<2>(engine)};
    const auto a = with_factor.update(with_factor.predict(f, step), m);
    const auto b = with_covariance.update(with_covariance.predict(e, step), m);
    CHECK(laws::estimate_distance(b.posterior, kalman::unfactored(a.posterior)) < 1e-9);
    CHECK(a.chi2 == Approx(b.chi2).epsilon(1e-9));
    f = a.posterior;
    e = b.posterior;
  }
}

TEST_CASE("the square-root filter stays positive definite over a million ill-conditioned steps", "[kalman]") {
  const auto found = ill_conditioned::drive<double, kalman::square_root, true>(kalman::square_root{}, 1'000'000);
  CHECK(found.failed == 0);
  CHECK(found.not_symmetric == 0);
  CHECK(found.not_positive_definite == 0);
  // Joseph's form walks the same path.
  const auto joseph = ill_conditioned::drive<double>(kalman::joseph{}, 1000);
  const auto root = ill_conditioned::drive<double, kalman::square_root, true>(kalman::square_root{}, 1000);
  CHECK((joseph.last - root.last).cwiseQuotient(root.last).cwiseAbs().maxCoeff() < 1e-6);
}

TEST_CASE("the square-root policy on a covariance, and in single precision, stays positive definite", "[kalman]") {
  CHECK(ill_conditioned::drive<double>(kalman::square_root{}, 10'000).not_positive_definite == 0);
  const auto found = ill_conditioned::drive<float, kalman::square_root, true>(kalman::square_root{}, 100'000);
  CHECK(found.failed == 0);
  CHECK(found.not_positive_definite == 0);
}

TEST_CASE("an exact measurement of something known exactly is refused", "[kalman]") {
  const kalman::factored_estimate<double, 2> known{{1.0, 2.0}, Eigen::Vector2d(0.0, 1.0).asDiagonal()};
  const auto u = kalman::square_root{}(known, models::position{3.0, 0.0});
  CHECK(u.status.why == kalman::reason::singular_innovation);
  CHECK(u.posterior.mean == known.mean);
  CHECK(std::isnan(u.chi2));
}

TEST_CASE("a measurement with a negative variance is not taken for an exact one", "[kalman]") {
  const kalman::factored_estimate<double, 2> before{{1.0, 2.0}, Eigen::Vector2d(2.0, 1.0).asDiagonal()};
  const auto u = kalman::square_root{}(before, models::linear_values<2, 1>{scifi::vector<double, 1>::Constant(3.0), {1.0, 0.0}, scifi::matrix<double, 1, 1>::Constant(-1.0)});
  CHECK(u.status.why == kalman::reason::not_positive_definite);
  CHECK(u.posterior.mean == before.mean);
  CHECK(std::isnan(u.chi2));
}
