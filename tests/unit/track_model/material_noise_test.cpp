// SPDX-License-Identifier: MPL-2.0
#include <scifi/track_model/material_noise.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include <scifi/core/units.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/materials.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/material/straggling.hpp>
#include <scifi/track_model/energy_loss_propagator.hpp>
#include <scifi/track_model/helix_propagator.hpp>

#include "dual.hpp"
#include "laws/process_noise_laws.hpp"
#include "support/catch.hpp"

using namespace scifi;
using ss = slope_state;
using state = vector<double, 5>;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
const helix_propagator no_field{0.0};
const helix_propagator in_field{4.0 * units::tesla};

/// A variance of the projected angle of so much per mm of path, so that nothing here leans on Highland's formula.
struct scattering_per_length {
  double rad2_per_mm;
  template <class Scalar>
  Scalar variance(const Scalar&, const particle&, const slab& slice, const Scalar& path) const {
    return Scalar(rad2_per_mm * slice.thickness) * path;
  }
};

/// A variance of the energy of so much per mm of path.
struct straggling_per_length {
  double mev2_per_mm;
  template <class Scalar>
  Scalar variance(const Scalar&, const particle&, const slab& slice, const Scalar& path) const {
    return Scalar(mev2_per_mm * slice.thickness) * path;
  }
};

template <class Flight>
auto flying(const Flight& flight) {
  return energy_loss_propagator{flight, no_energy_loss{}, muon_plus, 1};
}

/// Turns a direction by independent normal angles about two axes across it, of this standard deviation each.
vector<double, 3> scattered(const vector<double, 3>& direction, double sigma, std::mt19937_64& engine) {
  std::normal_distribution<double> normal(0.0, sigma);
  const vector<double, 3> aside(1.0, 0.0, 0.0);
  const vector<double, 3> u = (aside - aside.dot(direction) * direction).normalized();
  const vector<double, 3> v(direction[1] * u[2] - direction[2] * u[1], direction[2] * u[0] - direction[0] * u[2], direction[0] * u[1] - direction[1] * u[0]);
  const double a = normal(engine), b = normal(engine);
  const double angle = std::hypot(a, b);
  const double sine_over_angle = angle > 0.0 ? std::sin(angle) / angle : 1.0;
  return std::cos(angle) * direction + sine_over_angle * (a * u + b * v);
}

vector<double, 3> direction_of(const state& x) { return vector<double, 3>(x[ss::tx], x[ss::ty], 1.0).normalized(); }

/// The state with another direction, at the same place and momentum.
state redirected(const state& x, const vector<double, 3>& direction) {
  const double cosine = 1.0 / std::hypot(1.0, x[ss::tx], x[ss::ty]);
  return {x[ss::x], direction[0] / direction[2], x[ss::y], direction[1] / direction[2], x[ss::q_over_pz] * cosine / direction[2]};
}

/// Compares a covariance with that of simulated ends about `centre`, element by element, in standard deviations of the sample covariance
/// of a normal distribution, var(c_ij) = (c_ii c_jj + c_ij^2) / N. Returns the largest.
template <class Simulate>
double worst_deviation(const matrix<double, 5, 5>& expected, const state& centre, int samples, const Simulate& simulate) {
  matrix<double, 5, 5> sum = matrix<double, 5, 5>::Zero();
  for (int i = 0; i < samples; ++i) {
    const state d = simulate() - centre;
    sum += d * d.transpose();
  }
  sum /= samples;
  double worst = 0.0;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j <= i; ++j) {
      const double sigma = std::sqrt((expected(i, i) * expected(j, j) + expected(i, j) * expected(i, j)) / samples);
      const double off = std::abs(sum(i, j) - expected(i, j));
      const double d = off > 0.0 ? off / sigma : 0.0;
      if (!(d <= worst)) worst = d;
    }
  return worst;
}

constexpr int samples = 20000;
// 15 elements within 4.2 standard deviations each: one wrong alarm in 2500 seeds. A wrong factor of 1.06 in a variance would show.
constexpr double allowed = 4.2;
const state inclined(12.0, 0.4, -34.0, -0.3, 1.0 / 200.0);

}  // namespace

TEST_CASE("the slope covariance of an inclined track is that of a direction turned about two axes across it", "[track_model]") {
  std::mt19937_64 engine(20240501);
  const double sigma = 2e-3;
  leg thin{0.0, 1, {}, {}, {}};
  thin.finish.add({materials::polystyrene, 1.0, 0.0});
  const double path = std::hypot(1.0, inclined[ss::tx], inclined[ss::ty]);
  const material_noise noise{scattering_per_length{sigma * sigma / path}, no_straggling{}, muon_plus};
  const auto moved = flying(no_field).propagate(inclined, thin);
  const matrix<double, 5, 5> expected = noise.covariance(inclined, thin, moved);
  const auto simulate = [&] { return redirected(inclined, scattered(direction_of(inclined), sigma, engine)); };
  // q/pz follows the slopes: its correlation with each of them is checked with the others.
  CHECK(worst_deviation(expected, inclined, samples, simulate) < allowed);
  CHECK(std::abs(expected(ss::tx, ss::ty)) > 0.1 * std::sqrt(expected(ss::tx, ss::tx) * expected(ss::ty, ss::ty)));
}

TEST_CASE("a thick scatterer moves and turns an inclined track as many thin ones do, in both directions of the step", "[track_model]") {
  std::mt19937_64 engine(20240502);
  for (const double dz : {300.0, -300.0}) {
    INFO("dz " << dz);
    leg thick{dz, dz > 0.0 ? 1 : -1, {}, {}, {}};
    thick.gap.add({materials::air, 300.0, 0.0});
    const double per_mm = 1e-8;
    const material_noise noise{scattering_per_length{per_mm}, no_straggling{}, muon_plus};
    const auto moved = flying(no_field).propagate(inclined, thick);
    const matrix<double, 5, 5> expected = noise.covariance(inclined, thick, moved);
    constexpr int slices = 20;  // each scatters in its middle: variances are off by 1/(4 slices^2) at most
    const double length = dz / slices;
    const double sigma = std::sqrt(per_mm * std::abs(length) * std::hypot(1.0, inclined[ss::tx], inclined[ss::ty]));
    const auto simulate = [&] {
      state x = inclined;
      for (int i = 0; i < slices; ++i) {
        x = no_field.propagate(x, 0.5 * length).state;
        x = redirected(x, scattered(direction_of(x), sigma, engine));
        x = no_field.propagate(x, 0.5 * length).state;
      }
      return x;
    };
    CHECK(worst_deviation(expected, moved.state, samples, simulate) < allowed);
  }
}

TEST_CASE("thin material at the start acts at the end through lever arm and field", "[track_model]") {
  std::mt19937_64 engine(20240503);
  leg step{200.0, 1, {}, {}, {}};
  step.start.add({materials::polystyrene, 1.0, 0.0});
  step.finish.add({materials::polystyrene, 1.0, 0.0});
  const double per_mm = 1e-6;
  const material_noise noise{scattering_per_length{per_mm}, no_straggling{}, muon_plus};
  const auto moved = flying(in_field).propagate(inclined, step);
  const double sigma = std::sqrt(per_mm * std::hypot(1.0, inclined[ss::tx], inclined[ss::ty]));  // the field keeps the angle to z
  const auto simulate = [&] {
    const state departing = redirected(inclined, scattered(direction_of(inclined), sigma, engine));
    const state arriving = in_field.propagate(departing, step.dz).state;
    return redirected(arriving, scattered(direction_of(arriving), sigma, engine));
  };
  CHECK(worst_deviation(noise.covariance(inclined, step, moved), moved.state, samples, simulate) < allowed);
}

TEST_CASE("material at the start equals the same material at the end of a step before", "[track_model]") {
  const material_noise noise{highland_scattering{}, bohr_straggling{}, muon_plus};
  leg before{0.0, 1, {}, {}, {}}, after{250.0, 1, {}, {}, {}};
  before.finish.add(whole(materials::polystyrene, 0.627)).add(whole(materials::mylar, 0.025));
  after.start = before.finish;
  const auto here = flying(in_field).propagate(inclined, before);
  const auto moved = flying(in_field).propagate(inclined, leg{250.0, 1, {}, {}, {}});
  const matrix<double, 5, 5> expected = moved.jacobian * noise.covariance(inclined, before, here) * moved.jacobian.transpose();
  const matrix<double, 5, 5> got = noise.covariance(inclined, after, moved);
  const vector<double, 5> sigma = expected.diagonal().cwiseSqrt();
  CHECK(test::deviation<5, 5>(got, expected, sigma, sigma.cwiseInverse()) < 64.0 * eps);
}

TEST_CASE("slices of a slab make together what the slab makes, thin and thick, without field", "[track_model]") {
  const material_noise noise{highland_scattering{}, landau_straggling{}, muon_plus};
  const auto model = flying(no_field);
  const auto same = [](const matrix<double, 5, 5>& a, const matrix<double, 5, 5>& b) {
    const vector<double, 5> sigma = (b.diagonal().array() + std::numeric_limits<double>::min()).sqrt();
    return test::deviation<5, 5>(a, b, sigma, sigma.cwiseInverse()) < 256.0 * eps;
  };
  for (const double dz : {350.0, -350.0}) {
    leg once{dz, 1, {}, {}, {}};
    const slab gas = whole(materials::helium, 350.0);
    once.gap.add(gas);
    const auto moved = model.propagate(inclined, once);
    const matrix<double, 5, 5> expected = noise.covariance(inclined, once, moved);
    for (const int n : {2, 7, 100}) {
      leg part{dz / n, 1, {}, {}, {}};
      part.gap.add(split(gas, n));
      matrix<double, 5, 5> sum = matrix<double, 5, 5>::Zero();
      state x = inclined;
      for (int i = 0; i < n; ++i) {
        const auto next = model.propagate(x, part);
        sum = (next.jacobian * sum * next.jacobian.transpose() + noise.covariance(x, part, next)).eval();
        x = next.state;
      }
      INFO("dz " << dz << " slices " << n);
      CHECK(same(sum, expected));
    }
  }
  leg one{0.0, 1, {}, {}, {}}, four = one;
  const slab plastic = whole(materials::polystyrene, 0.6);
  one.finish.add(plastic);
  for (int i = 0; i < 4; ++i) four.finish.add(split(plastic, 4));
  const auto still = model.propagate(inclined, one);
  CHECK(same(noise.covariance(inclined, four, still).bottomRightCorner<5, 5>(), noise.covariance(inclined, one, still)));
  const material_noise split_scattering{highland_scattering{}, no_straggling{}, muon_plus};
  leg at_start{0.0, 1, {}, {}, {}};
  at_start.start = four.finish;
  CHECK(same(split_scattering.covariance(inclined, at_start, still), split_scattering.covariance(inclined, one, still)));
}

TEST_CASE("straggling moves q/pz by its derivative in the energy", "[track_model]") {
  const double per_mm = 0.01;  // MeV^2
  const material_noise noise{no_scattering{}, straggling_per_length{per_mm}, muon_plus};
  leg step{0.0, 1, {}, {}, {}};
  step.finish.add({materials::polystyrene, 1.0, 0.0});
  for (const double k : {1.0 / 150.0, -1.0 / 300.0}) {
    state x = inclined;
    x[ss::q_over_pz] = k;
    const double path = std::hypot(1.0, x[ss::tx], x[ss::ty]);
    const double p = path / std::abs(k);
    const double energy = std::hypot(p, muon_plus.mass);
    const auto k_at = [&](double e) { return std::copysign(path / std::sqrt(e * e - muon_plus.mass * muon_plus.mass), k); };
    const double h = 1e-3 * energy;  // the third derivative is about 10 k / E^3 here: an error of 1e-6 or so, doubled by the square
    const double derivative = (k_at(energy + h) - k_at(energy - h)) / (2.0 * h);
    const matrix<double, 5, 5> q = noise.covariance(x, step, flying(no_field).propagate(x, step));
    CHECK(q(ss::q_over_pz, ss::q_over_pz) == Approx(derivative * derivative * per_mm * path).epsilon(2e-5));
    CHECK(q.topLeftCorner<4, 4>().norm() == 0.0);
    CHECK(q.topRightCorner<4, 1>().norm() == 0.0);
  }
}

TEST_CASE("the noise is symmetric and positive semidefinite for any leg, and none for a leg without material", "[track_model]") {
  const material_noise noise{highland_scattering{}, bohr_straggling{}, muon_plus};
  for (const int direction : {+1, -1})
    for (const int parts : {1, 2, 3, 4, 5, 6, 7})
      for (const double k : {1.0 / 60.0, -1.0 / 200.0}) {
        state x = inclined;
        x[ss::q_over_pz] = k;
        leg step{direction * 300.0, direction, {}, {}, {}};
        if ((parts & 1) != 0) step.start.add(whole(materials::polystyrene, 0.6));
        if ((parts & 2) != 0) step.gap.add(whole(materials::helium, 299.0));
        if ((parts & 4) != 0) step.finish.add(whole(materials::polystyrene, 0.6)).add(whole(materials::mylar, 0.03));
        INFO("direction " << direction << " parts " << parts << " k " << k);
        CHECK(laws::smallest_noise_eigenvalue(noise, flying(in_field), x, step) > -64.0 * eps);
        CHECK(laws::noise_norm(noise, flying(in_field), x, step) > 0.0);
      }
  CHECK(laws::noise_norm(noise, flying(in_field), inclined, leg{300.0, 1, {}, {}, {}}) == 0.0);
}

TEST_CASE("no scattering and no straggling is no noise", "[track_model]") {
  leg step{300.0, 1, {}, {}, {}};
  step.start.add(whole(materials::polystyrene, 0.6));
  step.gap.add(whole(materials::helium, 299.0));
  CHECK(laws::noise_norm(material_noise{no_scattering{}, no_straggling{}, muon_plus}, flying(in_field), inclined, step) == 0.0);
}

TEST_CASE("without field the noise of a line is that of the bent track at the same momentum", "[track_model]") {
  const double p = std::hypot(1.0, inclined[ss::tx], inclined[ss::ty]) / inclined[ss::q_over_pz];
  const material_noise bent{highland_scattering{}, no_straggling{}, muon_plus};
  const line_material_noise straight{highland_scattering{}, muon_plus, p};
  for (const int direction : {+1, -1}) {
    leg step{direction * 300.0, direction, {}, {}, {}};
    step.start.add(whole(materials::polystyrene, 0.6)).add(whole(materials::mylar, 0.03));
    step.gap.add(whole(materials::helium, 299.0));
    step.finish.add(whole(materials::polystyrene, 0.3));
    const matrix<double, 5, 5> of_bent = bent.covariance(inclined, step, flying(no_field).propagate(inclined, step));
    const matrix<double, 4, 4> expected = of_bent.topLeftCorner<4, 4>();
    const matrix<double, 4, 4> got = straight.covariance(vector<double, 4>(inclined.head<4>()), step);
    const vector<double, 4> sigma = expected.diagonal().cwiseSqrt();
    CHECK(test::deviation<4, 4>(got, expected, sigma, sigma.cwiseInverse()) < 64.0 * eps);
    CHECK((got - got.transpose()).norm() == 0.0);
  }
}

TEST_CASE("along the axis a thick scatterer has the textbook covariance", "[track_model]") {
  // PDG 2024, eqs. 34.20-34.22: y_plane = x theta0 / sqrt 3, correlation with the angle sqrt(3)/2.
  const state axial(0.0, 0.0, 0.0, 0.0, 1.0 / 200.0);
  leg step{500.0, 1, {}, {}, {}};
  step.gap.add(whole(materials::air, 500.0));
  const material_noise noise{highland_scattering{}, no_straggling{}, muon_plus};
  const matrix<double, 5, 5> q = noise.covariance(axial, step, flying(no_field).propagate(axial, step));
  const double beta = 200.0 / std::hypot(200.0, muon_plus.mass);
  const double x0 = 500.0 / (36.62 / 1.205e-3 * 10.0);
  const double theta0 = 13.6 / (beta * 200.0) * std::sqrt(x0) * (1.0 + 0.038 * std::log(x0 / (beta * beta)));
  CHECK(std::sqrt(q(ss::tx, ss::tx)) == Approx(theta0).epsilon(1e-12));
  CHECK(std::sqrt(q(ss::x, ss::x)) == Approx(500.0 * theta0 / std::sqrt(3.0)).epsilon(1e-12));
  CHECK(q(ss::x, ss::tx) / std::sqrt(q(ss::x, ss::x) * q(ss::tx, ss::tx)) == Approx(std::sqrt(3.0) / 2.0).epsilon(1e-12));
  CHECK(q(ss::x, ss::y) == 0.0);
  CHECK(q(ss::q_over_pz, ss::q_over_pz) == 0.0);
}

TEST_CASE("in single precision the noise errs by its rounding", "[track_model]") {
  const double single = std::numeric_limits<float>::epsilon();
  const material_noise noise{highland_scattering{}, bohr_straggling{}, muon_plus};
  leg step{300.0, 1, {}, {}, {}};
  step.start.add(whole(materials::polystyrene, 0.6));
  step.gap.add(whole(materials::helium, 299.0));
  step.finish.add(whole(materials::polystyrene, 0.3));
  const vector<float, 5> rounded = inclined.cast<float>();
  const state start = rounded.cast<double>();
  const matrix<double, 5, 5> exact = noise.covariance(start, step, flying(in_field).propagate(start, step));
  const matrix<float, 5, 5> got = noise.covariance(rounded, step, flying(in_field).propagate(rounded, step));
  CHECK(got == got.transpose());
  const vector<double, 5> sigma = exact.diagonal().cwiseSqrt();
  CHECK(test::deviation<5, 5>(got.cast<double>(), exact, sigma, sigma.cwiseInverse()) < 64.0 * single);

  const line_material_noise straight{highland_scattering{}, muon_plus, 200.0};
  const matrix<double, 4, 4> line = straight.covariance(vector<double, 4>(start.head<4>()), step);
  const matrix<float, 4, 4> line_got = straight.covariance(vector<float, 4>(rounded.head<4>()), step);
  const vector<double, 4> line_sigma = line.diagonal().cwiseSqrt();
  CHECK(test::deviation<4, 4>(line_got.cast<double>(), line, line_sigma, line_sigma.cwiseInverse()) < 64.0 * single);
}
