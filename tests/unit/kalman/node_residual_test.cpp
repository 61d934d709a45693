// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <optional>
#include <vector>

#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/node_residual.hpp>
#include <scifi/kalman/site.hpp>
#include <scifi/kalman/smoother.hpp>

#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

namespace {

using values = models::linear_values<3, 2>;
using site = kalman::site<models::matrix_step<3>, std::optional<values>>;

std::vector<site> random_track(std::mt19937_64& engine) {
  std::vector<site> track;
  for (int k = 0; k < 6; ++k)
    track.push_back({{models::random_matrix<3, 3>(engine), models::random_covariance<3>(engine)},
                     values{models::random_matrix<2, 1>(engine), models::random_matrix<2, 3>(engine), models::random_covariance<2>(engine)}});
  return track;
}

std::vector<kalman::node<double, 3, 2>> fitted(const std::vector<site>& track, double gate = 1e9) {
  std::vector<kalman::node<double, 3, 2>> nodes(track.size());
  const kalman::estimate<double, 3> start{Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()};
  const auto r = kalman::filter{models::step_transition{}, models::step_noise{}, kalman::joseph{}, kalman::chi2_gate{gate}}.run(start, track, nodes);
  REQUIRE(r.status.ok());
  REQUIRE(kalman::smooth(nodes).ok());
  return nodes;
}

}  // namespace

TEST_CASE("residuals of a node are those of its estimates", "[kalman]") {
  std::mt19937_64 engine(18);
  const auto track = random_track(engine);
  for (const auto& n : fitted(track)) {
    CHECK((kalman::predicted_residual(n).covariance - (n.measurement_covariance + n.projection * n.predicted.covariance * n.projection.transpose())).norm() < 1e-11);
    CHECK((kalman::filtered_residual(n).covariance - (n.measurement_covariance - n.projection * n.filtered.covariance * n.projection.transpose())).norm() < 1e-11);
    CHECK((kalman::smoothed_residual(n).covariance - (n.measurement_covariance - n.projection * n.smoothed.covariance * n.projection.transpose())).norm() < 1e-11);
  }
  const auto nodes = fitted(track);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const values& m = *track[k].measurement;
    CHECK((kalman::predicted_residual(nodes[k]).value - (m.z - m.h * nodes[k].predicted.mean)).norm() < 1e-12);
    CHECK((kalman::filtered_residual(nodes[k]).value - (m.z - m.h * nodes[k].filtered.mean)).norm() < 1e-12);
    CHECK((kalman::smoothed_residual(nodes[k]).value - (m.z - m.h * nodes[k].smoothed.mean)).norm() < 1e-12);
  }
}

TEST_CASE("the unbiased residual is that of a fit without the measurement", "[kalman]") {
  std::mt19937_64 engine(19);
  for (int trial = 0; trial < 10; ++trial) {
    const auto track = random_track(engine);
    const auto nodes = fitted(track);
    for (std::size_t k = 0; k < track.size(); ++k) {
      auto without = track;
      without[k].measurement.reset();
      const auto others = fitted(without)[k].smoothed;
      const auto expected = kalman::residual_if_unused(others, *track[k].measurement);
      const auto unbiased = kalman::unbiased_residual(nodes[k]);
      CHECK((unbiased.value - expected.value).norm() < 1e-7 * (1.0 + expected.value.norm()));
      CHECK((unbiased.covariance - expected.covariance).norm() < 1e-7 * expected.covariance.norm());
    }
  }
}

TEST_CASE("an outlier's residuals are seen from estimates that do not contain it", "[kalman]") {
  std::mt19937_64 engine(20);
  auto track = random_track(engine);
  track[3].measurement->z = Eigen::Vector2d(1e4, -1e4);
  const auto nodes = fitted(track, 1e4);
  REQUIRE(nodes[3].outlier);
  track[3].measurement.reset();
  CHECK(kalman::unbiased_residual(nodes[3]).covariance ==
        kalman::smoothed_residual(nodes[3]).covariance);
  CHECK((nodes[3].smoothed.mean - fitted(track)[3].smoothed.mean).norm() < 1e-12);
  CHECK(kalman::smoothed_residual(nodes[3]).covariance(0, 0) > nodes[3].measurement_covariance(0, 0));
}

TEST_CASE("a node without a measurement has an empty residual", "[kalman]") {
  std::mt19937_64 engine(21);
  auto track = random_track(engine);
  track[2].measurement.reset();
  const auto nodes = fitted(track);
  CHECK(kalman::unbiased_residual(nodes[2]).value.size() == 0);
  CHECK(kalman::chi2(kalman::predicted_residual(nodes[2])) == 0.0);
}
