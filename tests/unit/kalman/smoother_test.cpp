// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <vector>

#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/site.hpp>
#include <scifi/kalman/smoother.hpp>

#include "laws/update_laws.hpp"
#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

namespace {

/// Random models with noise at every step: filter and smoother against stacked least squares, state by state.
template <int N, int M>
void check_against_batch(std::mt19937_64& engine) {
  constexpr int sites = 6;
  using step = models::matrix_step<N>;
  using values = models::linear_values<N, M>;
  const kalman::estimate<double, N> start{models::random_matrix<N, 1>(engine), models::random_covariance<N>(engine)};
  std::vector<kalman::site<step, values>> track;
  models::batch all(sites + 1, N);
  all.add(0, Eigen::MatrixXd::Identity(N, N), start.mean, start.covariance);
  for (int k = 0; k < sites; ++k) {
    track.push_back({{models::random_matrix<N, N>(engine), models::random_covariance<N>(engine)},
                     {models::random_matrix<M, 1>(engine), models::random_matrix<M, N>(engine), models::random_covariance<M>(engine)}});
    const auto& s = track.back();
    Eigen::MatrixXd dynamics(N, 2 * N);
    dynamics << -s.step.f, Eigen::MatrixXd::Identity(N, N);
    all.add(k, dynamics, Eigen::VectorXd::Zero(N), s.step.q);
    all.add(k + 1, s.measurement.h, s.measurement.z, s.measurement.r);
  }
  all.solve();

  std::vector<kalman::node<double, N, M>> nodes(sites);
  const auto run = kalman::filter{models::step_transition{}, models::step_noise{}}.run(start, track, nodes);
  REQUIRE(run.status.ok());
  REQUIRE(kalman::smooth(nodes).ok());
  CHECK(run.ndf == sites * M);
  CHECK(run.chi2 == Approx(all.chi2()).epsilon(1e-8));
  for (int k = 0; k < sites; ++k) {
    const auto& n = nodes[static_cast<std::size_t>(k)];
    const kalman::estimate<double, N> expected{all.mean(k + 1), all.covariance(k + 1)};
    CHECK(laws::estimate_distance(expected, n.smoothed) < 1e-7);
    CHECK(n.smoothed.covariance == n.smoothed.covariance.transpose());
  }
  CHECK(laws::estimate_distance(nodes.back().filtered, {all.mean(sites), all.covariance(sites)}) < 1e-7);
}

template <int N>
void check_dimensions(std::mt19937_64& engine) {
  for (int trial = 0; trial < 3; ++trial) {
    check_against_batch<N, 1>(engine);
    check_against_batch<N, 2>(engine);
    check_against_batch<N, 3>(engine);
  }
}

}  // namespace

TEST_CASE("filter and smoother are batch least squares, for 1 to 6 components and 1 to 3 measured values", "[kalman]") {
  std::mt19937_64 engine(12);
  check_dimensions<1>(engine);
  check_dimensions<2>(engine);
  check_dimensions<3>(engine);
  check_dimensions<4>(engine);
  check_dimensions<5>(engine);
  check_dimensions<6>(engine);
}

TEST_CASE("runs forward and backward agree after smoothing", "[kalman]") {
  // The start is known badly enough to leave no trace: relative weight 1e-10.
  const auto vague = kalman::uncorrelated(Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(1e4, 1e4));
  using site = kalman::site<std::optional<double>, models::position>;
  std::mt19937_64 engine(13);
  std::normal_distribution<double> normal;
  std::vector<site> forward, backward;
  for (int k = 0; k < 10; ++k) forward.push_back({k == 0 ? std::optional<double>{} : 0.5, {0.3 * k + 0.1 * normal(engine), 0.1}});
  for (int k = 9; k >= 0; --k) backward.push_back({k == 9 ? std::optional<double>{} : -0.5, forward[static_cast<std::size_t>(k)].measurement});
  const kalman::filter f{models::constant_velocity{}, models::white_acceleration{0.1}};
  std::vector<kalman::node<double, 2, 1>> there(10), back(10);
  REQUIRE(f.run(vague, forward, there).status.ok());
  REQUIRE(f.run(vague, backward, back).status.ok());
  REQUIRE(kalman::smooth(there).ok());
  REQUIRE(kalman::smooth(back).ok());
  for (std::size_t k = 0; k < 10; ++k) CHECK(laws::estimate_distance(there[k].smoothed, back[9 - k].smoothed) < 1e-6);
}

TEST_CASE("smoothing in single precision after a vague start keeps what the textbook difference loses", "[kalman]") {
  using site = kalman::site<double, models::position>;
  const std::vector<site> sites(20, site{0.5, {1.0, 0.1}});
  const kalman::filter f{models::constant_velocity{}, models::white_acceleration{1e-4}};
  const kalman::estimate<float, 2> vague{Eigen::Vector2f::Zero(), 2e4F * Eigen::Matrix2f::Identity()};
  std::vector<kalman::node<float, 2, 1>> nodes(20);
  REQUIRE(f.run(vague, sites, nodes).status.ok());
  REQUIRE(kalman::smooth(nodes).ok());
  const kalman::estimate<double, 2> precise{vague.mean.cast<double>(), vague.covariance.cast<double>()};
  std::vector<kalman::node<double, 2, 1>> reference(20);
  REQUIRE(f.run(precise, sites, reference).status.ok());
  REQUIRE(kalman::smooth(reference).ok());

  const auto error = [&](const Eigen::Matrix2f& c) { return (c.cast<double>() - reference[0].smoothed.covariance).norm() / reference[0].smoothed.covariance.norm(); };
  const Eigen::Matrix2f gain = nodes[0].filtered.covariance * nodes[1].jacobian.transpose() * nodes[1].predicted.covariance.inverse();
  const Eigen::Matrix2f textbook = nodes[0].filtered.covariance + gain * (nodes[1].smoothed.covariance - nodes[1].predicted.covariance) * gain.transpose();
  CHECK(error(nodes[0].smoothed.covariance) < 0.05);
  CHECK(error(nodes[0].smoothed.covariance) < 0.5 * error(textbook));
  for (const auto& n : nodes) CHECK(Eigen::LLT<Eigen::Matrix2f>(n.smoothed.covariance).info() == Eigen::Success);
}

TEST_CASE("a predicted covariance that cannot be inverted is named at its node", "[kalman]") {
  const auto known = kalman::uncorrelated(Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(1.0, 0.0));
  using site = kalman::site<double, models::position>;
  const std::vector<site> sites(3, site{0.0, {1.0, 0.1}});
  std::vector<kalman::node<double, 2, 1>> nodes(3);
  REQUIRE(kalman::filter{models::constant_velocity{}, kalman::no_noise{}}.run(known, sites, nodes).status.ok());
  const auto status = kalman::smooth(nodes);
  CHECK(status == kalman::status{kalman::step_kind::smooth, kalman::reason::not_positive_definite});
  CHECK(nodes[1].status == status);
}
