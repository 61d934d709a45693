// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <Eigen/Eigenvalues>

#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/symmetric_form.hpp>

#include "laws/update_laws.hpp"
#include "unit/kalman/ill_conditioned.hpp"
#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

namespace {

/// Largest relative error of the covariance over 100 steps of a system that grows by 1.3 a step, against Joseph's form in extended precision.
template <class Update>
double error_of_unstable_system(const Update& update) {
  using state = scifi::matrix<double, 6, 6>;
  using wide = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  std::mt19937_64 engine(23);
  const auto drawn = models::random_matrix<6, 6>(engine);
  const state f = drawn * (1.3 / Eigen::EigenSolver<state>(drawn).eigenvalues().cwiseAbs().maxCoeff());
  const state q = 0.01 * state::Identity();
  const models::linear_values<6, 3> m{Eigen::Vector3d::Ones(), models::random_matrix<3, 6>(engine), Eigen::Matrix3d::Identity()};
  const kalman::filter filter{models::step_transition{}, models::step_noise{}, update};
  const wide wf = f.cast<long double>(), wq = q.cast<long double>(), wh = m.h.cast<long double>(), one = wide::Identity(6, 6);
  kalman::estimate<double, 6> e{scifi::vector<double, 6>::Zero(), state::Identity()};
  wide p = one;
  double worst = 0.0;
  for (int i = 0; i < 100; ++i) {
    e = filter.update(filter.predict(e, models::matrix_step<6>{f, q}), m).posterior;
    p = wf * p * wf.transpose() + wq;
    const wide k = p * wh.transpose() * (wh * p * wh.transpose() + wide::Identity(3, 3)).inverse();
    const wide a = one - k * wh;
    p = a * p * a.transpose() + k * k.transpose();
    worst = std::max(worst, static_cast<double>((e.covariance.cast<long double>() - p).norm() / p.norm()));
  }
  return worst;
}

}  // namespace

TEST_CASE("the symmetric form equals the information form and is symmetric to the last bit", "[kalman]") {
  std::mt19937_64 engine(22);
  for (int trial = 0; trial < 100; ++trial) {
    const kalman::estimate<double, 5> prior{models::random_matrix<5, 1>(engine), models::random_covariance<5>(engine)};
    const models::linear_values<5, 3> m{models::random_matrix<3, 1>(engine), models::random_matrix<3, 5>(engine), models::random_covariance<3>(engine)};
    const auto u = kalman::symmetric_form{}(prior, m);
    REQUIRE(u.status.ok());
    const scifi::matrix<double, 5, 5> information = prior.covariance.inverse() + m.h.transpose() * m.r.inverse() * m.h;
    const scifi::matrix<double, 5, 5> covariance = information.inverse();
    const scifi::vector<double, 5> mean = covariance * (prior.covariance.inverse() * prior.mean + m.h.transpose() * m.r.inverse() * m.z);
    CHECK(laws::estimate_distance(u.posterior, kalman::estimate<double, 5>{mean, covariance}) < 1e-9);
    CHECK(u.posterior.covariance == u.posterior.covariance.transpose());
  }
}

TEST_CASE("no update lets an unstable system run away from its covariance", "[kalman]") {
  // P -= K (P H')' on storage that is not kept symmetric ends with an error of 1e30 here.
  CHECK(error_of_unstable_system(kalman::symmetric_form{}) < 1e-13);
  CHECK(error_of_unstable_system(kalman::joseph{}) < 1e-13);
}

TEST_CASE("the symmetric form says so where a measurement is too precise for it", "[kalman]") {
  const auto found = ill_conditioned::drive<double>(kalman::symmetric_form{}, 1000);
  CHECK(found.failed + found.not_positive_definite > 900);
  CHECK(found.not_symmetric == 0);
}
