// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include <scifi/kalman/bryson_frazier.hpp>
#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/node_residual.hpp>
#include <scifi/kalman/run.hpp>
#include <scifi/kalman/site.hpp>
#include <scifi/kalman/smoother.hpp>
#include <scifi/kalman/square_root.hpp>

#include "laws/update_laws.hpp"
#include "unit/kalman/batch.hpp"
#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

namespace {

using node = kalman::node<double, 2, 1>;
using site = kalman::site<double, models::position>;

const kalman::estimate<double, 2> start = kalman::uncorrelated(Eigen::Vector2d(0.0, 1.0), Eigen::Vector2d(1.0, 0.5));

}  // namespace

TEST_CASE("a run is predict and update at every site", "[kalman]") {
  const kalman::filter f{models::constant_velocity{}, models::white_acceleration{0.1}};
  const std::vector<site> sites{{1.0, {1.1, 0.1}}, {2.0, {2.8, 0.1}}, {-0.5, {2.4, 0.1}}};
  std::vector<node> nodes(3);
  const auto result = f.run(start, sites, nodes);
  kalman::estimate<double, 2> e = start;
  double chi2 = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto p = f.predict(e, sites[k].step);
    const auto u = f.update(p, sites[k].measurement);
    CHECK(nodes[k].predicted.covariance == p.estimate.covariance);
    CHECK(nodes[k].filtered.mean == u.posterior.mean);
    CHECK(nodes[k].jacobian == p.jacobian);
    CHECK(nodes[k].residual(0) == u.residual(0));
    chi2 += u.chi2;
    e = u.posterior;
  }
  CHECK(result.reached == 3);
  CHECK(result.chi2 == chi2);
  CHECK(result.ndf == 3);
  CHECK(result.failed_at == kalman::no_failure);
}

TEST_CASE("dimensions 1, 2, 3 and none mix within one run and count in ndf", "[kalman]") {
  using two = models::linear_values<2, 2>;
  using three = models::linear_values<2, 3>;
  using any = std::variant<kalman::no_measurement, models::position, two, three>;
  std::mt19937_64 engine(14);
  const two pair{models::random_matrix<2, 1>(engine), models::random_matrix<2, 2>(engine), models::random_covariance<2>(engine)};
  const three triple{models::random_matrix<3, 1>(engine), models::random_matrix<3, 2>(engine), models::random_covariance<3>(engine)};
  const std::vector<kalman::site<std::optional<double>, any>> sites{
      {kalman::at_start, models::position{0.1, 0.1}}, {1.0, pair}, {1.0, kalman::no_measurement{}}, {1.0, triple}};
  std::vector<kalman::node<double, 2, 3>> nodes(4);
  const auto result = kalman::filter{models::constant_velocity{}, models::white_acceleration{0.1}}.run(start, sites, nodes);
  REQUIRE(result.status.ok());
  CHECK(result.ndf == 6);
  CHECK(nodes[0].predicted.covariance == start.covariance);
  CHECK(nodes[2].measurement_dimension == 0);
  CHECK(nodes[2].filtered.covariance == nodes[2].predicted.covariance);
  CHECK(nodes[3].residual.size() == 3);

  // The same by stacked least squares over the five states.
  models::batch all(4, 2);
  all.add(0, Eigen::Matrix2d::Identity(), start.mean, start.covariance);
  all.add(0, Eigen::RowVector2d(1.0, 0.0), Eigen::VectorXd::Constant(1, 0.1), Eigen::MatrixXd::Constant(1, 1, 0.01));
  for (int k = 0; k < 3; ++k) {
    Eigen::Matrix<double, 2, 4> dynamics;
    dynamics << -models::constant_velocity{}.transition(1.0), Eigen::Matrix2d::Identity();
    all.add(k, dynamics, Eigen::Vector2d::Zero(), models::white_acceleration{0.1}.covariance(1.0));
  }
  all.add(1, pair.h, pair.z, pair.r);
  all.add(3, triple.h, triple.z, triple.r);
  all.solve();
  REQUIRE(kalman::smooth(nodes).ok());
  for (int k = 0; k < 4; ++k) CHECK(laws::estimate_distance({all.mean(k), all.covariance(k)}, nodes[static_cast<std::size_t>(k)].smoothed) < 1e-9);
  CHECK(result.chi2 == Approx(all.chi2()).epsilon(1e-10));
}

TEST_CASE("outliers are recorded and count neither in chi2 nor in ndf", "[kalman]") {
  const std::vector<site> sites{{1.0, {1.0, 0.1}}, {1.0, {50.0, 0.1}}, {1.0, {3.0, 0.1}}};
  std::vector<node> nodes(3);
  const auto result = kalman::filter{models::constant_velocity{}, models::white_acceleration{0.1}, kalman::joseph{}, kalman::chi2_gate{16.0}}.run(start, sites, nodes);
  CHECK(result.ndf == 2);
  CHECK(nodes[1].outlier);
  CHECK(nodes[1].chi2 > 16.0);
  CHECK(nodes[1].filtered.mean == nodes[1].predicted.mean);
  CHECK(result.chi2 == nodes[0].chi2 + nodes[2].chi2);
}

TEST_CASE("a run that fails keeps what it had and names site, step and reason", "[kalman]") {
  const kalman::filter f{models::constant_velocity{}, models::white_acceleration{0.1}};
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<site> bad_step{{1.0, {1.0, 0.1}}, {1.0, {2.0, 0.1}}, {nan, {3.0, 0.1}}, {1.0, {4.0, 0.1}}};
  std::vector<node> nodes(4);
  const auto result = f.run(start, bad_step, nodes);
  CHECK(result.reached == 2);
  CHECK(result.failed_at == 2);
  CHECK(result.status == kalman::status{kalman::step_kind::predict, kalman::reason::not_finite});
  CHECK(nodes[2].status == result.status);
  CHECK(result.ndf == 2);
  CHECK(kalman::smooth(std::span(nodes).first(result.reached)).ok());

  const std::vector<site> bad_value{{1.0, {nan, 0.1}}};
  CHECK(f.run(start, bad_value, nodes).status == kalman::status{kalman::step_kind::update, kalman::reason::not_finite});
  std::vector<node> few(1);
  const auto short_of_nodes = f.run(start, bad_step, few);
  CHECK(short_of_nodes.status.why == kalman::reason::out_of_space);
  CHECK(short_of_nodes.reached == 1);
  const std::vector<Eigen::Vector2d> references(1, start.mean);
  CHECK(f.run(start, bad_step, nodes, references).status.why == kalman::reason::missing_reference);
  CHECK(f.run(f.predict(start, nan), bad_step, nodes).failed_at == 0);
  CHECK(nodes[0].status.why == kalman::reason::not_finite);
}

TEST_CASE("what an earlier, longer run left in the nodes is not smoothed", "[kalman]") {
  const kalman::filter f{models::constant_velocity{}, models::white_acceleration{0.1}};
  const std::vector<site> sites{{1.0, {1.0, 0.1}}, {1.0, {2.0, 0.1}}, {1.0, {3.0, 0.1}}, {1.0, {4.0, 0.1}}, {1.0, {5.0, 0.1}}};
  std::vector<node> nodes(6);
  constexpr kalman::status not_reached{kalman::step_kind::predict, kalman::reason::not_reached};
  REQUIRE(f.run(start, sites, nodes).reached == 5);
  CHECK(kalman::smooth(nodes) == not_reached);
  nodes.resize(5);
  CHECK(kalman::smooth(nodes).ok());
  const auto shorter = f.run(start, std::span(sites).first(2), nodes);
  REQUIRE(shorter.reached == 2);
  CHECK(kalman::smooth(nodes) == not_reached);
  CHECK(kalman::smooth(nodes, kalman::modified_bryson_frazier{}) == not_reached);
  CHECK(kalman::smooth(std::span(nodes).first(shorter.reached)).ok());
}

TEST_CASE("a run from a factored estimate leaves the same nodes", "[kalman]") {
  const std::vector<site> sites(5, site{1.0, {1.0, 0.1}});
  std::vector<node> a(5), b(5);
  REQUIRE(kalman::filter{models::constant_velocity{}, models::white_acceleration{0.1}}.run(start, sites, a).status.ok());
  REQUIRE(kalman::filter{models::constant_velocity{}, models::white_acceleration{0.1}, kalman::square_root{}}.run(kalman::factored(start), sites, b).status.ok());
  for (std::size_t k = 0; k < 5; ++k) CHECK(laws::estimate_distance(a[k].filtered, b[k].filtered) < 1e-11);
}

TEST_CASE("references change nothing for a linear model", "[kalman]") {
  const kalman::filter linear{models::constant_velocity{}, models::white_acceleration{0.1}};
  const std::vector<site> sites(5, site{1.0, {1.0, 0.1}});
  std::vector<node> a(5), b(5);
  REQUIRE(linear.run(start, sites, a).status.ok());
  const std::vector<Eigen::Vector2d> anywhere(6, Eigen::Vector2d(7.0, -3.0));
  REQUIRE(linear.run(start, sites, b, anywhere).status.ok());
  for (std::size_t k = 0; k < 5; ++k) CHECK(laws::estimate_distance(a[k].filtered, b[k].filtered) < 1e-11);
}

TEST_CASE("over ten thousand tracks chi2 has the moments of chi-squared and the pulls those of a normal", "[kalman]") {
  constexpr int tracks = 10'000, sites_per_track = 5;
  std::mt19937_64 engine(15);
  std::normal_distribution<double> normal;
  const models::white_acceleration noise{0.2};
  const kalman::filter f{models::constant_velocity{}, noise};
  const Eigen::Matrix2d kick = noise.covariance(1.0).llt().matrixL();
  double sum = 0.0, sum2 = 0.0, pulls = 0.0, pulls2 = 0.0, unbiased = 0.0, unbiased2 = 0.0;
  std::vector<site> sites(sites_per_track, site{1.0, {0.0, 0.3}});
  std::vector<node> nodes(sites_per_track);
  for (int t = 0; t < tracks; ++t) {
    Eigen::Vector2d x = start.mean + Eigen::Vector2d(1.0 * normal(engine), 0.5 * normal(engine));
    for (auto& s : sites) {
      x = models::constant_velocity{}.transition(1.0) * x + kick * Eigen::Vector2d(normal(engine), normal(engine));
      s.measurement.z = x(0) + 0.3 * normal(engine);
    }
    const auto result = f.run(start, sites, nodes);
    REQUIRE(result.status.ok());
    REQUIRE(kalman::smooth(nodes).ok());
    sum += result.chi2;
    sum2 += result.chi2 * result.chi2;
    const double pull = (nodes[4].filtered.mean(1) - x(1)) / kalman::sigma(nodes[4].filtered, 1);
    pulls += pull;
    pulls2 += pull * pull;
    const double u = kalman::pull(kalman::unbiased_residual(nodes[2]));
    unbiased += u;
    unbiased2 += u * u;
  }
  const double n = tracks, k = sites_per_track, mean = sum / n, variance = sum2 / n - mean * mean;
  // Mean k with variance 2k/n; variance 2k with variance (mu4 - sigma^4)/n = (48k + 8k^2)/n. Four standard deviations.
  CHECK(std::abs(mean - k) < 4.0 * std::sqrt(2.0 * k / n));
  CHECK(std::abs(variance - 2.0 * k) < 4.0 * std::sqrt((48.0 * k + 8.0 * k * k) / n));
  // A standard normal: mean of variance 1/n, mean square of variance 2/n.
  CHECK(std::abs(pulls / n) < 4.0 / std::sqrt(n));
  CHECK(std::abs(pulls2 / n - 1.0) < 4.0 * std::sqrt(2.0 / n));
  CHECK(std::abs(unbiased / n) < 4.0 / std::sqrt(n));
  CHECK(std::abs(unbiased2 / n - 1.0) < 4.0 * std::sqrt(2.0 / n));
}
