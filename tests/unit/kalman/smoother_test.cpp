// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <Eigen/Dense>

#include <limits>
#include <optional>
#include <random>
#include <variant>
#include <vector>

#include <scifi/kalman/bryson_frazier.hpp>
#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/site.hpp>
#include <scifi/kalman/smoother.hpp>

#include "unit/kalman/batch.hpp"
#include "unit/kalman/dense.hpp"

namespace kalman = scifi::kalman;

namespace {

/// One or three measured numbers where the state has an odd number of components, two or four where even: all there are, at half the compiling.
constexpr int fewest_of(int n) { return n % 2 == 0 ? 2 : 1; }
template <int N>
inline constexpr int fewest = fewest_of(N);
template <int N>
using some_values = std::variant<models::linear_values<N, fewest<N>>, models::linear_values<N, fewest<N> + 2>>;

/// A linear system with noise at every step: what is known at its first site, the steps between sites and what is seen at each.
struct linear_system {
  dense::knowledge start;
  std::vector<dense::knowledge> steps;  // transition and noise
  std::vector<dense::observation> seen;
};

/// Transitions that turn and stretch by 0.7 to 1.4, so that they can be undone without loss.
linear_system random_system(std::mt19937_64& engine, int n, int sites) {
  std::bernoulli_distribution more;
  std::uniform_real_distribution<double> stretching(0.7, 1.4);
  linear_system s{dense::random_knowledge(engine, n), {}, {}};
  for (int k = 0; k < sites; ++k) {
    s.seen.push_back(dense::random_observation(engine, n, fewest_of(n) + (more(engine) ? 2 : 0)));
    if (k + 1 == sites) break;
    dense::matrix f = dense::random_rotation(engine, n);
    for (int i = 0; i < n; ++i) f.row(i) *= stretching(engine);
    s.steps.push_back({f, dense::random_covariance(engine, n)});
  }
  return s;
}

/// All states at once: the start, the noise of every step and every measurement are rows.
models::batch by_least_squares(const linear_system& s) {
  const int sites = static_cast<int>(s.seen.size()), n = static_cast<int>(s.start.mean.size());
  models::batch all(sites, n);
  all.add(0, dense::matrix::Identity(n, n), s.start.mean, s.start.covariance);
  for (int k = 0; k < sites; ++k) {
    const auto& o = s.seen[static_cast<std::size_t>(k)];
    all.add(k, o.h, o.z, o.r);
    if (k + 1 == sites) break;
    dense::matrix dynamics(n, 2 * n);
    dynamics << -s.steps[static_cast<std::size_t>(k)].mean, dense::matrix::Identity(n, n);
    all.add(k, dynamics, dense::matrix::Zero(n, 1), s.steps[static_cast<std::size_t>(k)].covariance);
  }
  all.solve();
  return all;
}

/// Time turned round: x = F^-1 (x' - w), with noise F^-1 Q F^-T. `end` is what is known at the new start.
linear_system turned_round(const linear_system& s, const dense::knowledge& end) {
  linear_system back{end, {}, {s.seen.rbegin(), s.seen.rend()}};
  for (auto step = s.steps.rbegin(); step != s.steps.rend(); ++step) {
    const dense::matrix f = step->mean.inverse();
    back.steps.push_back({f, dense::symmetric(f * step->covariance * f.transpose())});
  }
  return back;
}

template <int N>
using nodes_of = std::vector<kalman::node<double, N, 4>>;

template <int N>
[[gnu::noinline]] kalman::run_result<double> filtered(const linear_system& s, nodes_of<N>& nodes) {
  std::vector<kalman::site<std::optional<models::matrix_step<N>>, some_values<N>>> sites;
  for (std::size_t k = 0; k < s.seen.size(); ++k) {
    std::optional<models::matrix_step<N>> step;
    if (k > 0) step = models::matrix_step<N>{dense::fixed<N, N>(s.steps[k - 1].mean), dense::fixed<N, N>(s.steps[k - 1].covariance)};
    if (s.seen[k].z.size() == fewest<N>) sites.push_back({step, dense::fixed_values<N, fewest<N>>(s.seen[k])});
    else sites.push_back({step, dense::fixed_values<N, fewest<N> + 2>(s.seen[k])});
  }
  nodes.resize(sites.size());
  return kalman::filter{models::step_transition{}, models::step_noise{}}.run(dense::fixed_estimate<N>(s.start), sites, nodes);
}

template <int N>
std::vector<dense::knowledge> smoothed(const nodes_of<N>& nodes) {
  std::vector<dense::knowledge> out;
  for (const auto& n : nodes) {
    out.push_back(dense::knowledge_of(n.smoothed));
    CHECK(out.back().covariance == out.back().covariance.transpose());
  }
  return out;
}

/// Eigenvalues of all covariances lie between 0.1 and some 40: a rounding grows by their ratio in S^-1 or P^-1 and again where small is left of large.
constexpr double tolerance = 32.0 * 400.0 * 400.0 * std::numeric_limits<double>::epsilon();

void check_states(const models::batch& all, const std::vector<dense::knowledge>& states) {
  for (std::size_t k = 0; k < states.size(); ++k) CHECK(dense::distance({all.mean(static_cast<int>(k)), all.covariance(static_cast<int>(k))}, states[k]) < tolerance);
}

template <int N>
void check_smoothers(std::mt19937_64& engine) {
  INFO(N << " components");
  constexpr int sites = 6;
  const linear_system s = random_system(engine, N, sites);
  const models::batch all = by_least_squares(s);
  nodes_of<N> nodes;
  const auto run = filtered<N>(s, nodes);
  REQUIRE(run.status.ok());
  CHECK(run.chi2 == Approx(all.chi2()).epsilon(tolerance));
  CHECK(dense::distance({all.mean(sites - 1), all.covariance(sites - 1)}, dense::knowledge_of(nodes.back().filtered)) < tolerance);
  nodes_of<N> other = nodes;

  REQUIRE(kalman::smooth(nodes).ok());
  check_states(all, smoothed<N>(nodes));
  CHECK(nodes.back().smoothed.mean == nodes.back().filtered.mean);
  CHECK(nodes.back().smoothed.covariance == nodes.back().filtered.covariance);

  REQUIRE(kalman::smooth(other, kalman::modified_bryson_frazier{}).ok());
  check_states(all, smoothed<N>(other));
  CHECK(other.back().smoothed.mean == other.back().filtered.mean);
  CHECK(other.back().smoothed.covariance == other.back().filtered.covariance);
}

/// What is known as a measurement at the last site: in independent rows L^-1 x = L^-1 mean, C = L L', a few at a time.
void add_as_measurement(linear_system& s, const dense::knowledge& k) {
  const int n = static_cast<int>(k.mean.size()), few = fewest_of(n);
  const dense::matrix rows = dense::matrix(k.covariance.llt().matrixL()).inverse();
  for (int i = 0; i < n; i += few) {
    s.steps.push_back({dense::matrix::Identity(n, n), dense::matrix::Zero(n, n)});
    s.seen.push_back({rows.middleRows(i, few) * k.mean, rows.middleRows(i, few), dense::matrix::Identity(few, few)});
  }
}

/// A run from either end, each with what the other one set out from as a measurement at its last site: one problem, solved in two directions.
template <int N>
void check_directions(std::mt19937_64& engine) {
  INFO(N << " components");
  linear_system there = random_system(engine, N, 6);
  const dense::knowledge end = dense::random_knowledge(engine, N);
  linear_system back = turned_round(there, end);
  add_as_measurement(back, there.start);
  add_as_measurement(there, end);
  nodes_of<N> forward, backward;
  REQUIRE(filtered<N>(there, forward).status.ok());
  REQUIRE(filtered<N>(back, backward).status.ok());
  const auto compare = [&](const auto& smoother) {
    REQUIRE(kalman::smooth(forward, smoother).ok());
    REQUIRE(kalman::smooth(backward, smoother).ok());
    const auto a = smoothed<N>(forward), b = smoothed<N>(backward);
    for (std::size_t k = 0; k < 6; ++k) CHECK(dense::distance(a[k], b[5 - k]) < tolerance);
  };
  compare(kalman::rauch_tung_striebel{});
  compare(kalman::modified_bryson_frazier{});
}

}  // namespace

TEST_CASE("filter and both smoothers are batch least squares, for 1 to 9 components and 1 to 4 measured values", "[kalman]") {
  std::mt19937_64 engine(12);
  for (int trial = 0; trial < 5; ++trial) {
    check_smoothers<1>(engine);
    check_smoothers<2>(engine);
    check_smoothers<3>(engine);
    check_smoothers<4>(engine);
    check_smoothers<5>(engine);
    check_smoothers<6>(engine);
    check_smoothers<7>(engine);
    check_smoothers<8>(engine);
    check_smoothers<9>(engine);
  }
}

TEST_CASE("runs forward and backward agree after smoothing", "[kalman]") {
  std::mt19937_64 engine(13);
  for (int trial = 0; trial < 5; ++trial) {
    check_directions<1>(engine);
    check_directions<2>(engine);
    check_directions<3>(engine);
    check_directions<4>(engine);
    check_directions<5>(engine);
    check_directions<6>(engine);
    check_directions<7>(engine);
    check_directions<8>(engine);
    check_directions<9>(engine);
  }
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
