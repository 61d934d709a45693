// SPDX-License-Identifier: MPL-2.0
#include <scifi/track_model/conversions.hpp>

#include <Eigen/LU>

#include <cmath>
#include <limits>

#include "dual.hpp"
#include "support/catch.hpp"

using namespace scifi;
using test::derivative;
using test::deviation;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

// What counts as a change of one in each component.
const vector<double, 5> slope_units(1.0, 0.1, 1.0, 0.1, 1e-3);
const vector<double, 5> helix_units(1.0, 20.0, 1.0, 20.0, 1e-3);
const vector<double, 5> momentum_units(1.0, 1.0, 20.0, 20.0, 100.0);

/// A particle of `charge` that travels along `travel`: x = 3, y = -7 mm, p = (20, -35, 180 travel) MeV/c.
vector<double, 5> slopes(int charge, int travel) {
  const double pz = 180.0 * travel;
  return {3.0, 20.0 / pz, -7.0, -35.0 / pz, charge / pz};
}

template <class Check>
void for_each_particle(Check check) {
  for (const int charge : {+1, -1})
    for (const int travel : {+1, -1}) {
      INFO("charge " << charge << " travel " << travel);
      check(charge, travel);
    }
}

}  // namespace

TEST_CASE("slopes become the momenta of the particle, for both charges and directions", "[track_model]") {
  for_each_particle([](int charge, int travel) {
    const auto helix = slopes_to_helix(slopes(charge, travel), travel).state;
    CHECK(helix[helix_state::x] == 3.0);
    CHECK(helix[helix_state::y] == -7.0);
    CHECK(helix[helix_state::px] == Approx(20.0).epsilon(1e-14));
    CHECK(helix[helix_state::py] == Approx(-35.0).epsilon(1e-14));
    CHECK(helix[helix_state::q_over_pz] == charge / (180.0 * travel));
    const auto momentum = slopes_to_momentum(slopes(charge, travel), travel).state;
    CHECK(momentum[momentum_state::x] == 3.0);
    CHECK(momentum[momentum_state::y] == -7.0);
    CHECK(momentum[momentum_state::px] == Approx(20.0).epsilon(1e-14));
    CHECK(momentum[momentum_state::py] == Approx(-35.0).epsilon(1e-14));
    CHECK(momentum[momentum_state::pz] == Approx(180.0 * travel).epsilon(1e-14));
  });
}

TEST_CASE("conversions return to where they began", "[track_model]") {
  for_each_particle([](int charge, int travel) {
    const vector<double, 5> start = slopes(charge, travel);
    const auto helix = slopes_to_helix(start, travel);
    const auto back = helix_to_slopes(helix.state, travel);
    CHECK(((back.state - start).array() / slope_units.array()).abs().maxCoeff() < 16.0 * eps);
    const matrix<double, 5, 5> identity = matrix<double, 5, 5>::Identity();
    CHECK(deviation<5, 5>(back.jacobian * helix.jacobian, identity, slope_units, slope_units) < 64.0 * eps);

    const auto momentum = slopes_to_momentum(start, travel);
    const auto again = momentum_to_slopes(momentum.state, charge);
    CHECK(((again.state - start).array() / slope_units.array()).abs().maxCoeff() < 16.0 * eps);
    CHECK(deviation<5, 5>(again.jacobian * momentum.jacobian, identity, slope_units, slope_units) < 64.0 * eps);
  });
}

TEST_CASE("Jacobians of the conversions are those of dual numbers", "[track_model]") {
  for_each_particle([](int charge, int travel) {
    const vector<double, 5> start = slopes(charge, travel);
    const auto helix = slopes_to_helix(start, travel);
    CHECK(deviation<5, 5>(helix.jacobian, derivative<5, 5>([&](const auto& v) { return slopes_to_helix(v, travel).state; }, start), helix_units, slope_units) <
          64.0 * eps);
    CHECK(deviation<5, 5>(helix_to_slopes(helix.state, travel).jacobian,
                          derivative<5, 5>([&](const auto& v) { return helix_to_slopes(v, travel).state; }, helix.state), slope_units, helix_units) < 64.0 * eps);
    const auto momentum = slopes_to_momentum(start, travel);
    CHECK(deviation<5, 5>(momentum.jacobian, derivative<5, 5>([&](const auto& v) { return slopes_to_momentum(v, travel).state; }, start), momentum_units,
                          slope_units) < 64.0 * eps);
    CHECK(deviation<5, 5>(momentum_to_slopes(momentum.state, charge).jacobian,
                          derivative<5, 5>([&](const auto& v) { return momentum_to_slopes(v, charge).state; }, momentum.state), slope_units, momentum_units) <
          64.0 * eps);
    CHECK(derivative<4, 5>([](const auto& v) { return slopes_to_line(v).state; }, start) == slopes_to_line(start).jacobian);
    const vector<double, 4> line = slopes_to_line(start).state;
    CHECK(derivative<5, 4>([](const auto& v) { return line_to_slopes(v, test::dual<4>(0.005)).state; }, line) == line_to_slopes(line, 0.005).jacobian);
  });
}

TEST_CASE("a line takes its momentum from elsewhere", "[track_model]") {
  const vector<double, 5> start = slopes(+1, +1);
  const auto line = slopes_to_line(start);
  CHECK(line.state[line_state::x] == start[slope_state::x]);
  CHECK(line.state[line_state::ty] == start[slope_state::ty]);
  const auto back = line_to_slopes(line.state, start[slope_state::q_over_pz]);
  CHECK(back.state == start);
  CHECK(back.jacobian.row(slope_state::q_over_pz).norm() == 0.0);
  CHECK((line.jacobian * back.jacobian - matrix<double, 4, 4>::Identity()).norm() == 0.0);
}

TEST_CASE("a converted covariance gives functions of the state the variance they had", "[track_model]") {
  // The variance of a function of first order in the state is g' C g whichever space its gradient g is written in; here pt.
  kalman::estimate<double, 5> e{slopes(-1, -1), matrix<double, 5, 5>::Zero()};
  e.covariance.diagonal() << 0.04, 1e-6, 0.09, 4e-6, 1e-8;
  e.covariance(slope_state::x, slope_state::tx) = e.covariance(slope_state::tx, slope_state::x) = 1e-4;
  e.covariance(slope_state::ty, slope_state::q_over_pz) = e.covariance(slope_state::q_over_pz, slope_state::ty) = -5e-8;
  const auto momentum = convert(e, [](const vector<double, 5>& v) { return slopes_to_momentum(v, -1); });
  CHECK((momentum.covariance - momentum.covariance.transpose()).norm() == 0.0);

  const double pt = std::hypot(20.0, 35.0);
  vector<double, 5> in_momentum = vector<double, 5>::Zero();
  in_momentum[momentum_state::px] = 20.0 / pt;
  in_momentum[momentum_state::py] = -35.0 / pt;
  const auto pt_of_slopes = [](const auto& v) {
    using std::sqrt;
    using number = typename std::decay_t<decltype(v)>::Scalar;
    vector<number, 1> out;
    out[0] = sqrt(number(v[slope_state::tx] * v[slope_state::tx] + v[slope_state::ty] * v[slope_state::ty])) / magnitude(number(v[slope_state::q_over_pz]));
    return out;
  };
  const matrix<double, 1, 5> in_slopes = derivative<1, 5>(pt_of_slopes, e.mean);
  const double expected = (in_slopes * e.covariance * in_slopes.transpose())(0, 0);
  CHECK(in_momentum.dot(momentum.covariance * in_momentum) == Approx(expected).epsilon(1e-12));
  CHECK(momentum.covariance(momentum_state::x, momentum_state::x) == Approx(0.04).epsilon(1e-14));

  const auto helix = convert(e, [](const vector<double, 5>& v) { return slopes_to_helix(v, -1); });
  const auto back = convert(helix, [](const vector<double, 5>& v) { return helix_to_slopes(v, -1); });
  CHECK(((back.covariance - e.covariance).array() / e.covariance.array().abs().maxCoeff()).abs().maxCoeff() < 1e-14);
  CHECK(back.covariance(4, 4) == Approx(1e-8).epsilon(1e-12));
}

TEST_CASE("a momentum without bound shows as a number that is not finite", "[track_model]") {
  vector<double, 5> start = slopes(+1, +1);
  start[slope_state::q_over_pz] = 0.0;
  CHECK_FALSE(slopes_to_momentum(start, +1).state.allFinite());
  CHECK_FALSE(slopes_to_helix(start, +1).state.allFinite());
}

TEST_CASE("conversions work in single precision", "[track_model]") {
  constexpr float single = std::numeric_limits<float>::epsilon();
  const vector<double, 5> start = slopes(-1, +1);
  const vector<float, 5> rounded = start.cast<float>();
  const auto exact = slopes_to_momentum(start, +1);
  const auto got = slopes_to_momentum(rounded, +1);
  // Each component is one quotient and one product of rounded numbers.
  CHECK(((got.state.cast<double>() - exact.state).array() / exact.state.array()).abs().maxCoeff() < 4.0 * static_cast<double>(single));
  CHECK(deviation<5, 5>(got.jacobian.cast<double>(), exact.jacobian, momentum_units, slope_units) < 64.0 * static_cast<double>(single));
  const auto back = momentum_to_slopes(got.state, -1);
  CHECK(((back.state - rounded).array() / rounded.array()).abs().maxCoeff() < 8.0f * single);
}
