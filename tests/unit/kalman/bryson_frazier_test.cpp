// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <optional>
#include <vector>

#include <scifi/kalman/bryson_frazier.hpp>
#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/site.hpp>
#include <scifi/kalman/smoother.hpp>

#include "laws/update_laws.hpp"
#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

namespace {

/// Random models near the identity, some sites without a measurement and one outlier: both smoothers, and the start, agree.
template <int N, int M>
void check_against_rauch_tung_striebel(std::mt19937_64& engine) {
  using values = models::linear_values<N, M>;
  const kalman::estimate<double, N> start{models::random_matrix<N, 1>(engine), models::random_covariance<N>(engine)};
  std::vector<kalman::site<models::matrix_step<N>, std::optional<values>>> track;
  for (int k = 0; k < 8; ++k) {
    const scifi::matrix<double, N, N> f = scifi::matrix<double, N, N>::Identity() + 0.3 * models::random_matrix<N, N>(engine);
    track.push_back({{f, models::random_covariance<N>(engine)},
                     values{models::random_matrix<M, 1>(engine), models::random_matrix<M, N>(engine), models::random_covariance<M>(engine)}});
    if (k % 3 == 2) track.back().measurement.reset();
  }
  track[3].measurement->z *= 1e6;
  std::vector<kalman::node<double, N, M>> nodes(track.size());
  REQUIRE(kalman::filter{models::step_transition{}, models::step_noise{}, kalman::joseph{}, kalman::chi2_gate{1e6}}.run(start, track, nodes).status.ok());
  CHECK(nodes[3].outlier);
  auto other = nodes;
  kalman::estimate<double, N> begin = start, other_begin = start;
  REQUIRE(kalman::rauch_tung_striebel{}(std::span(nodes), &begin).ok());
  REQUIRE(kalman::modified_bryson_frazier{}(std::span(other), &other_begin).ok());
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    CHECK(laws::estimate_distance(nodes[k].smoothed, other[k].smoothed) < 1e-9);
    CHECK(other[k].smoothed.covariance == other[k].smoothed.covariance.transpose());
  }
  CHECK(laws::estimate_distance(begin, other_begin) < 1e-9);
}

}  // namespace

TEST_CASE("the smoother without inverses gives what the one of Rauch, Tung and Striebel gives", "[kalman]") {
  std::mt19937_64 engine(25);
  for (int trial = 0; trial < 5; ++trial) {
    check_against_rauch_tung_striebel<1, 1>(engine);
    check_against_rauch_tung_striebel<2, 1>(engine);
    check_against_rauch_tung_striebel<5, 1>(engine);
    check_against_rauch_tung_striebel<5, 2>(engine);
    check_against_rauch_tung_striebel<6, 3>(engine);
  }
}

TEST_CASE("a component known exactly does not stop the smoother without inverses", "[kalman]") {
  const auto known = kalman::uncorrelated(Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(1.0, 0.0));
  using site = kalman::site<double, models::position>;
  const std::vector<site> sites{{0.0, {1.0, 1.0}}, {0.0, {3.0, 1.0}}};
  std::vector<kalman::node<double, 2, 1>> nodes(2);
  REQUIRE(kalman::filter{models::constant_velocity{}, kalman::no_noise{}}.run(known, sites, nodes).status.ok());
  REQUIRE(kalman::smooth(nodes, kalman::modified_bryson_frazier{}).ok());
  // The mean of 0, 1 and 3, each of variance one.
  CHECK(nodes[0].smoothed.mean(0) == Approx(4.0 / 3.0));
  CHECK(nodes[0].smoothed.covariance(0, 0) == Approx(1.0 / 3.0));
}

TEST_CASE("the smoother without inverses hands on the status of a run that failed", "[kalman]") {
  std::vector<kalman::node<double, 2, 1>> nodes(2);
  CHECK(kalman::smooth(std::span(nodes).first(0), kalman::modified_bryson_frazier{}).ok());
  nodes[1].status = {kalman::step_kind::update, kalman::reason::not_finite};
  CHECK(kalman::smooth(nodes, kalman::modified_bryson_frazier{}) == nodes[1].status);
}
