// SPDX-License-Identifier: MPL-2.0
#include <scifi/alignment/track_linearisation.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <scifi/alignment/local_elimination.hpp>
#include <scifi/alignment/normal_equations.hpp>
#include <scifi/alignment/solution.hpp>
#include <scifi/core/random.hpp>

#include "support/catch.hpp"

using namespace scifi;
using namespace scifi::alignment;

namespace {

/// Position and slope along a line.
struct drift {
  [[nodiscard]] matrix<double, 2, 2> transition(double dz) const {
    matrix<double, 2, 2> f = matrix<double, 2, 2>::Identity();
    f(0, 1) = dz;
    return f;
  }
};

/// A thin scatterer at the start of each step, seen at its end.
struct kick_at_start {
  double angle;
  [[nodiscard]] matrix<double, 2, 2> covariance(double dz) const {
    const vector<double, 2> lever(dz * angle, angle);
    return lever * lever.transpose();
  }
};

constexpr double angle = 0.004;
constexpr std::array<double, 6> steps{0.0, 200.0, 1.0, 250.0, 0.5, 300.0};
constexpr int globals = 4;

/// What one track measured: each of two detectors has an offset and a scale.
struct made {
  std::vector<double> measured, sigma;
  std::vector<std::array<coefficient, 2>> global;
};

made make(std::uint64_t seed) {
  random_stream random(seed, 0, 0);
  made out;
  vector<double, 2> state(10.0 * random.normal(), 0.1 * random.normal());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    state[1] += i > 0 ? angle * random.normal() : 0.0;
    state[0] += steps[i] * state[1];
    const int offset = i % 2 == 0 ? 0 : 2;
    out.sigma.push_back(random.uniform(0.2, 0.6));
    out.global.push_back({{{offset, 1.0}, {offset + 1, 0.01 * static_cast<double>(i) + 0.01 * random.normal()}}});
    out.measured.push_back(state[0] + 0.3 * out.global.back()[0].value + out.sigma.back() * random.normal());
  }
  return out;
}

/// The same with one angle for each scatterer among the parameters of the track, measured to be zero within its width: a broken line.
track_equations broken_line(const made& from) {
  constexpr std::size_t locals = 2 + steps.size() - 1;
  track_equations out;
  out.clear(locals);
  std::array<double, locals> local{1.0};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    for (std::size_t k = 1; k < 2 + i && k < locals; ++k) local[k] += steps[i];
    out.add(from.measured[i], from.sigma[i], local, from.global[i]);
  }
  for (std::size_t k = 2; k < locals; ++k) {
    std::array<double, locals> one{};
    one[k] = 1.0;
    out.add(0.0, angle, one, {});
  }
  return out;
}

/// By the covariance, about a reference that is bent in its own way.
track_equations linearised(const made& from, std::uint64_t seed) {
  random_stream random(seed, 1, 0);
  std::vector<vector<double, 2>> reference;
  std::vector<stop_measurement<2>> measurements;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    reference.emplace_back(from.measured[i] + random.normal(), 0.1 * random.normal());
    stop_measurement<2> m;
    m.site = static_cast<int>(i);
    m.residual = from.measured[i] - reference.back()[0];
    m.variance = from.sigma[i] * from.sigma[i];
    m.projection(0) = 1.0;
    m.global = from.global[i];
    measurements.push_back(m);
  }
  const track_linearisation<drift, kick_at_start, 2> linearise({}, {angle});
  decltype(linearise)::buffers work;
  track_equations out;
  out.clear(2);
  REQUIRE(linearise(reference, steps, measurements, out, work) == failure::none);
  return out;
}

}  // namespace

TEST_CASE("a track with the covariance of its scattering says what a broken line with every kink a parameter says", "[alignment]") {
  normal_equations by_covariance(globals), by_kinks(globals);
  local_elimination eliminate;
  reduced_track one, other;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const made track = make(seed);
    eliminate(linearised(track, seed), globals, one);
    eliminate(broken_line(track), globals, other);
    REQUIRE(one.status == failure::none);
    REQUIRE(other.status == failure::none);
    CHECK(one.ndf == other.ndf);
    CHECK(one.chi2 == Approx(other.chi2).epsilon(1e-8));
    by_covariance.add(one);
    by_kinks.add(other);
  }
  CHECK((by_covariance.matrix() - by_kinks.matrix()).norm() <= 1e-9 * by_kinks.matrix().norm());
  CHECK((by_covariance.gradient() - by_kinks.gradient()).norm() <= 1e-8 * by_kinks.gradient().norm());
}

TEST_CASE("measurements may be missing or stand together at one place", "[alignment]") {
  const std::vector<vector<double, 2>> reference(3, vector<double, 2>::Zero());
  const std::array<double, 3> lengths{0.0, 100.0, 100.0};
  std::vector<stop_measurement<2>> measurements(3);
  for (auto& m : measurements) {
    m.site = 2;
    m.projection(0) = 1.0;
    m.residual = 1.0;
  }
  const track_linearisation<drift, kick_at_start, 2> linearise({}, {angle});
  decltype(linearise)::buffers work;
  track_equations out;
  out.clear(2);
  REQUIRE(linearise(reference, lengths, measurements, out, work) == failure::none);
  REQUIRE(out.size() == 3);
  // One thing measured three times: kicks of 0.8 and 0.4 mm, common to all, and an error of 1 mm each.
  const double common = angle * angle * (200.0 * 200.0 + 100.0 * 100.0);
  double information = 0.0;
  for (std::size_t i = 0; i < 3; ++i) information += out[i].local[0] * out[i].local[0];
  CHECK(information == Approx(1.0 / (common + 1.0 / 3.0)));
}

TEST_CASE("a track that is not finite or has no variance says so", "[alignment]") {
  const track_linearisation<drift, kick_at_start, 2> linearise({}, {angle});
  decltype(linearise)::buffers work;
  track_equations out;
  const std::array<double, 2> lengths{0.0, 100.0};
  const auto with = [&](double state, double variance) {
    const std::vector<vector<double, 2>> reference(2, vector<double, 2>(state, 0.0));
    stop_measurement<2> m;
    m.variance = variance;
    m.projection(0) = 1.0;
    m.site = 1;
    m.residual = -state;
    out.clear(2);
    return linearise(reference, lengths, std::span<const stop_measurement<2>>(&m, 1), out, work);
  };
  CHECK(with(0.0, 1.0) == failure::none);
  CHECK(with(std::numeric_limits<double>::quiet_NaN(), 1.0) == failure::not_finite);
  CHECK(with(0.0, -1.0) == failure::not_positive_definite);
  CHECK(with(0.0, std::numeric_limits<double>::infinity()) == failure::not_finite);
}
