// SPDX-License-Identifier: MPL-2.0
#include <scifi/information/fisher_information.hpp>

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Dense>

#include <scifi/core/random.hpp>
#include <scifi/kalman/site.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/material/straggling.hpp>
#include <scifi/track_model/energy_loss_propagator.hpp>
#include <scifi/track_model/fibre_measurement.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/line_propagator.hpp>
#include <scifi/track_model/material_noise.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

/// y and its derivatives along z: y, slope, curvature.
struct parabola {
  [[nodiscard]] matrix<double, 3, 3> transition(double dz) const { return matrix<double, 3, 3>{{1.0, dz, 0.5 * dz * dz}, {0.0, 1.0, dz}, {0.0, 0.0, 1.0}}; }
};

/// Scattering spread evenly over the path: slope variance `rate` a length.
struct spread_out_scattering {
  double rate;
  [[nodiscard]] matrix<double, 3, 3> covariance(double dz) const {
    const double t = rate * std::abs(dz);
    return matrix<double, 3, 3>{{t * dz * dz / 3.0, t * dz / 2.0, 0.0}, {t * dz / 2.0, t, 0.0}, {0.0, 0.0, 0.0}};
  }
};

template <int N>
struct height {
  double variance = 1.0;
  [[nodiscard]] double value() const { return std::numeric_limits<double>::quiet_NaN(); }  // nobody may look
  [[nodiscard]] double covariance() const { return variance; }
  [[nodiscard]] matrix<double, 1, N> projection() const {
    matrix<double, 1, N> h = matrix<double, 1, N>::Zero();
    h(0, 0) = 1.0;
    return h;
  }
};

/// A helix through material: legs of different lengths and stacks, measured at three angles.
struct bent_path {
  using flight = energy_loss_propagator<helix_propagator, mean_energy_loss>;
  using noise = material_noise<highland_scattering, bohr_straggling>;
  kalman::filter<flight, noise> filter{{{0.9}, {}, muon_plus, 1}, {{}, {}, muon_plus}};
  std::vector<kalman::site<leg, std::optional<fibre_measurement<slope_state>>>> sites;

  explicit bent_path(int direction) {
    for (int i = 0; i < 12; ++i) {
      leg l;
      l.dz = direction * (20.0 + 17.0 * i);
      l.direction = direction;
      l.start.add(whole(materials::polystyrene, 1.0 + 0.2 * i));
      l.gap.add(whole(materials::helium, 20.0 + 17.0 * i));
      l.finish.add(whole(materials::mylar, 0.3));
      const double angle = 2.1 * i;
      std::optional<fibre_measurement<slope_state>> m;
      if (i != 4) m = fibre_measurement<slope_state>{0.0, 0.1 + 0.02 * i, std::cos(angle), std::sin(angle), 3.0};
      sites.push_back({l, m});
    }
  }
};

/// All measurements at once: J = A' C^-1 A, A from central differences of the whole flight, C = R + what scattering the measurements share.
matrix<double, 5, 5> batch_information(const bent_path& path, const vector<double, 5>& start) {
  const auto seen = [&path](const vector<double, 5>& from) {
    std::vector<double> out;
    vector<double, 5> x = from;
    for (const auto& s : path.sites) {
      x = path.filter.propagator().propagate(x, s.step).state;
      if (s.measurement) out.push_back((s.measurement->projection() * x)(0));
    }
    return out;
  };
  const auto n = static_cast<Eigen::Index>(seen(start).size());
  Eigen::MatrixXd a(n, 5);
  for (int j = 0; j < 5; ++j) {
    vector<double, 5> up = start;
    vector<double, 5> down = start;
    const double h = j == slope_state::q_over_pz ? 1e-6 : 1e-3;
    up[j] += h;
    down[j] -= h;
    const auto above = seen(up);
    const auto below = seen(down);
    for (Eigen::Index i = 0; i < n; ++i) a(i, j) = (above[static_cast<std::size_t>(i)] - below[static_cast<std::size_t>(i)]) / (2.0 * h);
  }
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(n, n);
  // The noise of each step reaches all later measurements.
  vector<double, 5> x = start;
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < path.sites.size(); ++k) {
    const auto moved = path.filter.propagator().propagate(x, path.sites[k].step);
    const matrix<double, 5, 5> q = path.filter.noise().covariance(x, path.sites[k].step, moved);
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(n, 5);
    matrix<double, 5, 5> reach = matrix<double, 5, 5>::Identity();
    vector<double, 5> y = moved.state;
    Eigen::Index row = first;
    for (std::size_t l = k; l < path.sites.size(); ++l) {
      if (l > k) {
        const auto next = path.filter.propagator().propagate(y, path.sites[l].step);
        reach = next.jacobian * reach;
        y = next.state;
      }
      if (path.sites[l].measurement) b.row(row++) = path.sites[l].measurement->projection() * reach;
    }
    c += b * q * b.transpose();
    if (path.sites[k].measurement) {
      c(first, first) += path.sites[k].measurement->covariance();
      ++first;
    }
    x = moved.state;
  }
  return a.transpose() * c.ldlt().solve(a);
}

const vector<double, 5>& muon() {
  static const vector<double, 5> state = (vector<double, 5>() << 12.0, 0.15, -30.0, 0.08, 1.0 / 180.0).finished();
  return state;
}

}  // namespace

TEST_CASE("position and slope of a straight line through equal planes are known as by least squares", "[information]") {
  // Bevington, Data Reduction, eq. 6.21-6.23: var(slope) = s2 / sum (z - <z>)^2, var(y at z0) = s2 (1/n + (z0 - <z>)^2 / sum (z - <z>)^2).
  const kalman::filter f{parabola{}, kalman::no_noise{}};
  constexpr int planes = 9;
  constexpr double apart = 30.0;
  constexpr double variance = 0.04;
  std::vector<kalman::site<double, height<3>>> sites;
  for (int i = 0; i < planes; ++i) sites.push_back({apart, {variance}});
  const auto j = fisher_information(f, vector<double, 3>(0.0, 0.1, 0.0), sites);
  REQUIRE(j.status.ok());
  CHECK(j.measured == planes);
  const auto line = cramer_rao_bound<double, 2>(j.information.topLeftCorner<2, 2>());  // curvature known
  REQUIRE(line);
  const double middle = apart * (planes + 1) / 2.0;
  const double sum = apart * apart * planes * (planes * planes - 1.0) / 12.0;
  CHECK((*line)(1, 1) == Approx(variance / sum).epsilon(1e-10));
  CHECK((*line)(0, 0) == Approx(variance * (1.0 / planes + middle * middle / sum)).epsilon(1e-10));
}

TEST_CASE("the curvature in a uniform field is known as Gluckstern says", "[information]") {
  // Gluckstern, NIM 24 (1963) 381, eq. 18: N + 1 equal planes over L, var(curvature) = 720 N^3 / ((N-1)(N+1)(N+2)(N+3)) s2 / L^4.
  const kalman::filter f{parabola{}, kalman::no_noise{}};
  for (const int n : {2, 3, 10, 40}) {
    const double length = 800.0;
    std::vector<kalman::site<std::optional<double>, height<3>>> sites;
    for (int i = 0; i <= n; ++i) sites.push_back({i == 0 ? std::optional<double>() : length / n, {0.01}});
    const auto bound = cramer_rao_bound(fisher_information(f, vector<double, 3>(0.0, 0.0, 1e-4), sites).information);
    REQUIRE(bound);
    const double expected = 720.0 * n * n * n / ((n - 1.0) * (n + 1.0) * (n + 2.0) * (n + 3.0)) * 0.01 / std::pow(length, 4);
    CHECK((*bound)(2, 2) == Approx(expected).epsilon(1e-8));
  }
}

TEST_CASE("scattering all along leaves a curvature known to theta0 / L however good the planes", "[information]") {
  // The slope is then seen at both ends, and between them its random walk hides the curvature: var = rate / L (PDG 2024, eq. 35.46 and 34.16).
  const double rate = 2e-8;
  const double length = 1000.0;
  constexpr int steps = 400;
  const kalman::filter f{parabola{}, spread_out_scattering{rate}};
  std::vector<kalman::site<std::optional<double>, height<3>>> sites;
  for (int i = 0; i <= steps; ++i) sites.push_back({i == 0 ? std::optional<double>() : length / steps, {1e-12}});
  const auto bound = cramer_rao_bound(fisher_information(f, vector<double, 3>(0.0, 0.0, 1e-4), sites).information);
  REQUIRE(bound);
  // At the ends the slope is found over about one step: a share of the order of 1/steps.
  CHECK((*bound)(2, 2) == Approx(rate / length).epsilon(3.0 / steps));
}

TEST_CASE("one pass gives what all measurements at once give, correlated scattering included", "[information]") {
  for (const int direction : {1, -1}) {
    const bent_path path(direction);
    const auto j = fisher_information(path.filter, muon(), path.sites);
    REQUIRE(j.status.ok());
    CHECK(j.measured == 11);
    const matrix<double, 5, 5> batch = batch_information(path, muon());
    for (int i = 0; i < 5; ++i)
      for (int k = 0; k < 5; ++k) CHECK(j.information(i, k) == Approx(batch(i, k)).margin(1e-6 * std::sqrt(batch(i, i) * batch(k, k))));
  }
}

TEST_CASE("what lies on both sides of a surface adds up", "[information]") {
  // A state in the middle of a line without noise: the sum must be the information of all planes about their common middle.
  const kalman::filter f{line_propagator{}, kalman::no_noise{}};
  const auto side = [&f](double dz) {
    std::vector<kalman::site<double, height<4>>> sites(5, {dz, {0.09}});
    return fisher_information(f, vector<double, 4>(1.0, 0.1, 2.0, 0.2), sites).information;
  };
  const matrix<double, 4, 4> both = side(10.0) + side(-10.0);
  CHECK(both(0, 0) == Approx(10.0 / 0.09));
  CHECK(both(1, 1) == Approx(2.0 * 55.0 * 100.0 / 0.09));
  CHECK(both(0, 1) == Approx(0.0).margin(1e-9 * both(1, 1)));
}

TEST_CASE("a point tells what its two coordinates tell one after the other", "[information]") {
  const kalman::filter f{line_propagator{}, kalman::no_noise{}};
  matrix<double, 2, 2> covariance;
  covariance << 0.3, 0.0, 0.0, 0.7;
  gathered_information<double, 4> at_once(vector<double, 4>(0.0, 0.1, 0.0, 0.2));
  gathered_information<double, 4> in_turn = at_once;
  for (int i = 0; i < 3; ++i) {
    at_once.move(f, 100.0);
    in_turn.move(f, 100.0);
    at_once.measure(point_measurement<line_state>{{0.0, 0.0}, covariance});
    in_turn.measure(fibre_measurement<line_state>{0.0, 0.3, 1.0, 0.0, 0.0});
    in_turn.measure(fibre_measurement<line_state>{0.0, 0.7, 0.0, 1.0, 0.0});
  }
  CHECK(at_once.measured == in_turn.measured);
  CHECK((at_once.information - in_turn.information).norm() < 1e-10 * in_turn.information.norm());
}

TEST_CASE("a particle that stops tells what it told before", "[information]") {
  bent_path path(1);
  for (auto& s : path.sites) s.step.finish.add(whole(materials::polystyrene, 8.0));
  vector<double, 5> slow = muon();
  slow[slope_state::q_over_pz] = 1.0 / 70.0;
  const auto j = fisher_information(path.filter, slow, path.sites);
  CHECK(j.status.step == kalman::step_kind::predict);
  CHECK_FALSE(j.status.ok());
  CHECK(j.measured > 0);
  CHECK(j.measured < 11);
  CHECK(j.information.allFinite());
}

TEST_CASE("a state that the measurements do not fix has no bound", "[information]") {
  const kalman::filter f{line_propagator{}, kalman::no_noise{}};
  const std::vector<kalman::site<double, height<4>>> only_x(5, {10.0, {0.09}});
  CHECK_FALSE(cramer_rao_bound(fisher_information(f, vector<double, 4>(0.0, 0.1, 0.0, 0.2), only_x).information));
  CHECK_FALSE(cramer_rao_bound<double, 2>(matrix<double, 2, 2>{{1.0, 1.0}, {1.0, 1.0}}));
}

TEST_CASE("the bound is the inverse in any units", "[information]") {
  const matrix<double, 3, 3> unit{{2.0, 0.5, 0.1}, {0.5, 1.0, 0.3}, {0.1, 0.3, 3.0}};
  const vector<double, 3> scale(1e-9, 1.0, 1e9);
  const matrix<double, 3, 3> j = scale.asDiagonal() * unit * scale.asDiagonal();
  const auto bound = cramer_rao_bound(j);
  REQUIRE(bound);
  const matrix<double, 3, 3> product = scale.asDiagonal() * *bound * scale.asDiagonal() * unit;
  CHECK((product - matrix<double, 3, 3>::Identity()).norm() < 1e-12);
}
