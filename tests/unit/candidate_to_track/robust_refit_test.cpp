// SPDX-License-Identifier: MPL-2.0
#include <scifi/candidate_to_track/robust_refit.hpp>

#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Dense>

#include <scifi/core/random.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/kalman/site.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/track_model/energy_loss_propagator.hpp>
#include <scifi/track_model/line_propagator.hpp>

#include "support/catch.hpp"
#include "support/sample.hpp"

using namespace scifi;

namespace {

using line_filter = kalman::filter<leg_propagator<line_propagator>, line_material_noise<highland_scattering>>;

/// Straight muons of 200 MeV/c through the downstream tracker: everything is linear, and a dense calculation is exact.
struct bench {
  struct stop {
    std::optional<std::reference_wrapper<const leg>> step;
    std::optional<fibre_measurement<line_state>> measurement;
  };
  fit_path path = fit_path_of(mice::trackers().trackers[mice::downstream]);
  line_filter filter{{{}}, {{}, muon_plus, 200.0}};
  kalman::estimate<double, 4> start{vector<double, 4>::Zero(), vector<double, 4>(2500.0, 0.25, 2500.0, 0.25).asDiagonal()};
  std::vector<stop> sites;
  std::vector<vector<double, 4>> references;
  std::vector<kalman::node<double, 4, 1>> nodes;
  robust_refit::buffers<line_state> work;

  bench() {
    for (std::size_t i = 0; i <= path.surfaces.size(); ++i) {
      stop s{std::nullopt, std::nullopt};
      if (i > 0) s.step = path.legs[i];
      if (i < path.surfaces.size()) s.measurement = fibre_measurement<line_state>{0.0, 0.16, path.surfaces[i].cos_angle, path.surfaces[i].sin_angle, path.surfaces[i].offset};
      sites.push_back(s);
    }
    nodes.resize(sites.size());
    references.assign(sites.size() + 1, vector<double, 4>::Zero());
  }

  /// Noise of leg i with the material of `station` weighted.
  [[nodiscard]] matrix<double, 4, 4> noise(std::size_t i, int station, double weight) const {
    const auto of = [&](bool at_start, bool gap, bool at_finish) {
      leg l = path.legs[i];
      if (!at_start) l.start = {};
      if (!gap) l.gap = {};
      if (!at_finish) l.finish = {};
      return filter.noise().covariance(vector<double, 4>(vector<double, 4>::Zero()), l);
    };
    const double before = path.surfaces[i - 1].station == station ? weight : 1.0;
    const double after = i < path.surfaces.size() && path.surfaces[i].station == station ? weight : 1.0;
    return before * of(true, false, false) + of(false, true, false) + after * of(false, false, true);
  }

  /// Draws a muon: its states at the sites, last station first, and the measurements.
  std::vector<vector<double, 4>> fly(random_stream& random, const std::function<double(int)>& weight_of_station) {
    std::vector<vector<double, 4>> states;
    vector<double, 4> x(random.normal() * 30.0, random.normal() * 0.05, random.normal() * 30.0, random.normal() * 0.05);
    double weights[6];
    for (int s = 1; s <= 5; ++s) weights[s] = weight_of_station(s);
    for (std::size_t i = 0; i < sites.size(); ++i) {
      if (i > 0) {
        const matrix<double, 4, 4> f = line_propagator{}.transition(path.legs[i].dz);
        x = f * x;
        const int left = path.surfaces[i - 1].station;
        const int reached = i < path.surfaces.size() ? path.surfaces[i].station : left;
        matrix<double, 4, 4> q = noise(i, left, weights[left]);
        if (reached != left) q += noise(i, reached, weights[reached]) - noise(i, 0, 1.0);
        const matrix<double, 4, 4> factor = kalman::semidefinite_factor<double, 4>(q);
        x += factor * vector<double, 4>(random.normal(), random.normal(), random.normal(), random.normal());
      }
      states.push_back(x);
      if (sites[i].measurement) {
        auto& m = *sites[i].measurement;
        m.alpha = (m.projection() * x)(0) - m.offset + random.normal() * std::sqrt(m.alpha_variance);
      }
    }
    return states;
  }

  void fit_plainly() {
    REQUIRE(filter.run(start, sites, nodes, references).status.ok());
    REQUIRE(kalman::smooth(nodes).ok());
  }
};

/// Posterior of the last site's state and logarithm of the evidence, from all measurements at once.
struct dense {
  vector<double, 4> mean;
  matrix<double, 4, 4> covariance;
  double log_evidence;
};
using big = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;  // the broad prior costs a dozen digits
dense dense_fit(const bench& b, const std::function<matrix<double, 4, 4>(std::size_t)>& noise, const std::function<double(std::size_t)>& variance) {
  // All states as linear functions of (start, noise of each leg).
  const std::size_t n = b.sites.size();
  const auto size = static_cast<Eigen::Index>(4 * n);
  big covariance = big::Zero(size, size);
  covariance.topLeftCorner<4, 4>() = b.start.covariance.cast<long double>();
  big to_state = big::Zero(4, size);
  to_state.leftCols<4>().setIdentity();
  big h(15, size);
  Eigen::Matrix<long double, Eigen::Dynamic, 1> z(15);
  big r = big::Zero(15, 15);
  for (std::size_t i = 0; i < n; ++i) {
    const auto at = static_cast<Eigen::Index>(4 * i);
    if (i > 0) {
      to_state = (line_propagator{}.transition(b.path.legs[i].dz).cast<long double>() * to_state).eval();
      to_state.block<4, 4>(0, at).setIdentity();
      covariance.block<4, 4>(at, at) = noise(i).cast<long double>();
    }
    if (i < 15) {
      const auto row = static_cast<Eigen::Index>(i);
      h.row(row) = b.sites[i].measurement->projection().cast<long double>() * to_state;
      z(row) = b.sites[i].measurement->value();
      r(row, row) = variance(i);
    }
  }
  const big s = h * covariance * h.transpose() + r;
  const big gain = to_state * covariance * h.transpose() * s.inverse();
  const Eigen::LLT<big> factor(s);
  long double log_determinant = 0.0L;
  for (Eigen::Index i = 0; i < 15; ++i) log_determinant += 2.0L * std::log(factor.matrixL()(i, i));
  const big posterior = to_state * covariance * to_state.transpose() - gain * h * covariance * to_state.transpose();
  return {(gain * z).cast<double>(), posterior.cast<double>(), static_cast<double>(-0.5L * (z.dot(factor.solve(z)) + log_determinant))};
}

}  // namespace

TEST_CASE("the robust fit is the mean over all reasons, each weighted with its evidence", "[candidate_to_track]") {
  bench b;
  random_stream random(8, 1, 0);
  (void)b.fly(random, [](int station) { return station == 3 ? 6.0 : 1.0; });
  b.sites[7].measurement->alpha += 1.2;
  b.fit_plainly();
  const robust_refit refit{};
  REQUIRE(refit(b.filter, b.path, b.start, b.sites, b.references, b.work));

  const auto& tail = refit.tail;
  std::vector<dense> fits;
  std::vector<double> weights;
  const auto add = [&](int station, double v, std::size_t stray, double prior) {
    fits.push_back(dense_fit(
        b,
        [&](std::size_t i) {
          matrix<double, 4, 4> q = b.noise(i, 0, 1.0);
          for (const int inner : {2, 3, 4}) q += b.noise(i, inner, inner == station ? v : tail.variance[0]) - b.noise(i, 0, 1.0);
          return q;
        },
        [&](std::size_t i) { return i == stray ? refit.stray_variance : 0.16; }));
    weights.push_back(fits.back().log_evidence + std::log(prior));
  };
  add(0, 1.0, 99, 1.0);
  for (const int station : {2, 3, 4})
    for (const std::size_t i : {std::size_t{1}, std::size_t{2}}) add(station, tail.variance[i], 99, tail.share[i] / tail.share[0]);
  for (std::size_t i = 0; i < 15; ++i) add(0, 1.0, i, refit.stray_share);
  double sum = 0.0;
  vector<double, 4> mean = vector<double, 4>::Zero();
  for (std::size_t i = 0; i < fits.size(); ++i) {
    weights[i] = std::exp(weights[i] - fits[0].log_evidence);
    sum += weights[i];
    mean += weights[i] * fits[i].mean;
  }
  mean /= sum;
  matrix<double, 4, 4> covariance = matrix<double, 4, 4>::Zero();
  for (std::size_t i = 0; i < fits.size(); ++i) covariance += weights[i] / sum * (fits[i].covariance + (fits[i].mean - mean) * (fits[i].mean - mean).transpose());
  const auto& got = b.work.mean.back();
  for (int i = 0; i < 4; ++i) {
    CHECK(got.mean[i] == Approx(mean[i]).margin(1e-5 * std::sqrt(covariance(i, i))));
    for (int j = 0; j < 4; ++j) CHECK(got.covariance(i, j) == Approx(covariance(i, j)).margin(1e-5 * std::sqrt(covariance(i, i) * covariance(j, j))));
  }
}

TEST_CASE("a measurement far from the track counts as if it were not there", "[candidate_to_track]") {
  bench b;
  random_stream random(8, 2, 0);
  (void)b.fly(random, [](int) { return 1.0; });
  b.sites[6].measurement->alpha += 8.0;
  b.fit_plainly();
  const robust_refit refit{};
  REQUIRE(refit(b.filter, b.path, b.start, b.sites, b.references, b.work));
  const auto plain = b.nodes.back().smoothed;
  b.sites[6].measurement.reset();
  b.fit_plainly();
  const auto without = b.nodes.back().smoothed;
  const auto& got = b.work.mean.back();
  for (int i = 0; i < 4; ++i) {
    INFO(line_state::names[static_cast<std::size_t>(i)]);
    const double moved = std::abs(plain.mean[i] - without.mean[i]);
    CHECK(std::abs(got.mean[i] - without.mean[i]) < 0.2 * moved + 0.1 * kalman::sigma(without, i));
  }
}

TEST_CASE("hard scatters leave at most half of the plain fit's outliers, and the errors cover them", "[candidate_to_track]") {
  bench b;
  robust_refit refit{};
  refit.tail.share = {0.75, 1e-9, 0.25};  // more than in fibres, so that a small sample has enough
  refit.stray_share = 1e-9;
  test::sample plain_pull, robust_pull;
  constexpr std::size_t between = 5;  // the last surface of station 4 on the way
  constexpr int tracks = 4000;
  int plain_out = 0;
  int robust_out = 0;
  for (std::uint64_t i = 0; i < tracks; ++i) {
    random_stream random(9, i, 0);
    const auto states = b.fly(random, [&](int station) {
      if (station == 1 || station == 5) return 1.0;
      return refit.tail.variance[station == 3 && random.uniform() < refit.tail.share[2] ? 2 : 0];
    });
    b.fit_plainly();
    // Scattered hard in the third station, seen between it and the fourth: where the kick itself happens no fit can tell one side of it from the other.
    REQUIRE(refit(b.filter, b.path, b.start, b.sites, b.references, b.work));
    const double truth = states[between][line_state::tx];
    const double sigma = kalman::sigma(b.nodes[between].smoothed, line_state::tx);
    plain_pull.add((b.nodes[between].smoothed.mean[line_state::tx] - truth) / sigma);
    robust_pull.add((b.work.mean[between].mean[line_state::tx] - truth) / kalman::sigma(b.work.mean[between], line_state::tx));
    plain_out += std::abs(b.nodes[between].smoothed.mean[line_state::tx] - truth) > 4.0 * sigma;
    robust_out += std::abs(b.work.mean[between].mean[line_state::tx] - truth) > 4.0 * sigma;
  }
  REQUIRE(plain_out > 20);
  INFO(plain_out << " -> " << robust_out);
  CHECK(2 * robust_out <= plain_out);
  // Where a scatter is in doubt the stated errors cover it: they may be too wide, since the other stations are suspected as well, and not too narrow.
  CHECK(plain_pull.standard_deviation() > 1.2);
  CHECK(robust_pull.standard_deviation() < 1.05);
  CHECK(robust_pull.standard_deviation() > 0.7);
  CHECK(std::abs(robust_pull.mean()) < 4.0 / std::sqrt(tracks));
}
