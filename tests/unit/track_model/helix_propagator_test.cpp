// SPDX-License-Identifier: MPL-2.0
#include <scifi/track_model/helix_propagator.hpp>

#include <Eigen/LU>

#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <scifi/core/constants.hpp>
#include <scifi/core/units.hpp>
#include <scifi/track_model/conversions.hpp>

#include "dual.hpp"
#include "laws/propagator_laws.hpp"
#include "lorentz.hpp"
#include "support/catch.hpp"

using namespace scifi;
using ss = slope_state;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

const vector<double, 5> slope_units(1.0, 0.01, 1.0, 0.01, 1e-4);
const vector<double, 5> helix_units(1.0, 2.0, 1.0, 2.0, 1e-4);

/// Both charges, directions of travel, signs of the field and of the step; turning angles from 0.004 to 15 rad.
template <class Check>
void for_each_flight(Check check) {
  for (const int charge : {+1, -1})
    for (const int travel : {+1, -1})
      for (const double field : {3.0 * units::tesla, -4.0 * units::tesla})
        for (const double dz : {0.65, 199.3, -350.0, 1100.0})
          for (const double pz : {90.0, 200.0}) {
            INFO("charge " << charge << " travel " << travel << " field " << field << " dz " << dz << " pz " << pz);
            const vector<double, 5> start(12.0, 0.31 * travel, -34.0, -0.17, charge * travel / pz);
            check(charge, travel, field, dz, start);
          }
}

test::moving particle_of(const vector<double, 5>& slopes, int travel, int charge) {
  const auto p = slopes_to_momentum(slopes, travel).state;
  return {{p[momentum_state::x], p[momentum_state::y], 0.0}, {p[momentum_state::px], p[momentum_state::py], p[momentum_state::pz]}, double(charge)};
}

}  // namespace

TEST_CASE("the helix is the path that the Lorentz force integrates to", "[track_model]") {
  for_each_flight([](int charge, int travel, double field, double dz, const vector<double, 5>& start) {
    const auto end = helix_propagator{field}.propagate(start, dz);
    const test::moving reference =
        test::carried_to(particle_of(start, travel, charge), dz, [field](const vector<double, 3>&) { return vector<double, 3>(0.0, 0.0, field); });
    // At most a few hundred steps, each within the tolerance of numbers of order 100, amplified by lever arms of less than 10.
    const double tolerance = 1e4 * test::lorentz_tolerance;
    CHECK(std::abs(end.state[ss::x] - reference.position[0]) < tolerance * 100.0);
    CHECK(std::abs(end.state[ss::y] - reference.position[1]) < tolerance * 100.0);
    CHECK(std::abs(end.state[ss::tx] - reference.momentum[0] / reference.momentum[2]) < tolerance);
    CHECK(std::abs(end.state[ss::ty] - reference.momentum[1] / reference.momentum[2]) < tolerance);
    CHECK(std::abs(end.state[ss::q_over_pz] * reference.momentum[2] / charge - 1.0) < tolerance);
  });
}

TEST_CASE("the Jacobians of both helices are those of dual numbers, the column of q/pz included", "[track_model]") {
  for_each_flight([](int, int travel, double field, double dz, const vector<double, 5>& start) {
    const helix_propagator slopes{field};
    const auto in_slopes = test::derivative<5, 5>([&](const auto& v) { return slopes.propagate(v, dz).state; }, start);
    // Lever arms reach 1e3 mm and columns of q/pz 1e6 mm (MeV/c); each element is a few roundings of such terms.
    CHECK(test::deviation<5, 5>(slopes.propagate(start, dz).jacobian, in_slopes, slope_units, slope_units) < 1e4 * eps);

    const momentum_helix_propagator momenta{field, travel};
    const vector<double, 5> same = slopes_to_helix(start, travel).state;
    const auto in_momenta = test::derivative<5, 5>([&](const auto& v) { return momenta.propagate(v, dz).state; }, same);
    CHECK(test::deviation<5, 5>(momenta.propagate(same, dz).jacobian, in_momenta, helix_units, helix_units) < 1e4 * eps);
  });
}

TEST_CASE("the Jacobian of the helix agrees with finite differences", "[track_model]") {
  for_each_flight([](int, int, double field, double dz, const vector<double, 5>& start) {
    // Only q/pz enters non-linearly. A central difference of step u errs by u^2/6 of the third derivative, here at most
    // |dz| |t| (field dz)^3 for positions and |t| (field dz)^3 for slopes, plus rounding of the end state over u.
    const double step = 1e-2;
    const double per_unit = std::abs(field * dz) * slope_units[ss::q_over_pz];
    const double slope = std::hypot(start[ss::tx], start[ss::ty]);
    const double third = per_unit * per_unit * per_unit * slope * std::max(std::abs(dz) / slope_units[ss::x], 1.0 / slope_units[ss::tx]);
    const double largest = 50.0 + std::abs(dz) * slope;
    const double tolerance = step * step / 6.0 * third + 4.0 * eps * largest / step;
    CHECK(laws::propagator_jacobian_deviation(helix_propagator{field}, start, dz, step, slope_units) < tolerance);
  });
}

TEST_CASE("flights compose, return, keep the volume of phase space and stand still over no length", "[track_model]") {
  for_each_flight([](int, int travel, double field, double dz, const vector<double, 5>& start) {
    const helix_propagator slopes{field};
    constexpr double rounding = 1e3 * eps;  // turning angles up to 15 rad carry 15 eps each into positions of 1e2 mm
    CHECK(laws::composition_deviation(slopes, start, 0.3 * dz, 0.7 * dz, dz) < rounding);
    CHECK(laws::composition_deviation(slopes, start, 1.5 * dz, -0.5 * dz, dz) < rounding);
    CHECK(laws::round_trip_deviation(slopes, start, dz, -dz) < rounding);
    CHECK(slopes.propagate(start, dz).jacobian.determinant() == Approx(1.0).epsilon(1e-11));
    const auto still = slopes.propagate(start, 0.0);
    CHECK(still.state == start);
    CHECK((still.jacobian - matrix<double, 5, 5>::Identity()).norm() == 0.0);

    const momentum_helix_propagator momenta{field, travel};
    const vector<double, 5> same = slopes_to_helix(start, travel).state;
    CHECK(laws::composition_deviation(momenta, same, 0.3 * dz, 0.7 * dz, dz) < rounding);
    CHECK(laws::round_trip_deviation(momenta, same, dz, -dz) < rounding);
    CHECK(momenta.propagate(same, dz).jacobian.determinant() == Approx(1.0).epsilon(1e-11));
  });
}

TEST_CASE("the field turned round and the opposite charge together change nothing; one of them mirrors the path", "[track_model]") {
  for_each_flight([](int, int, double field, double dz, const vector<double, 5>& start) {
    const auto end = helix_propagator{field}.propagate(start, dz).state;
    vector<double, 5> conjugate = start;
    conjugate[ss::q_over_pz] = -start[ss::q_over_pz];
    const auto both = helix_propagator{-field}.propagate(conjugate, dz).state;
    CHECK(both.head<4>() == end.head<4>());
    CHECK(both[ss::q_over_pz] == -end[ss::q_over_pz]);

    // Mirrored about the x axis the other charge flies in the same field.
    conjugate[ss::y] = -start[ss::y];
    conjugate[ss::ty] = -start[ss::ty];
    const auto mirrored = helix_propagator{field}.propagate(conjugate, dz).state;
    CHECK(mirrored[ss::x] == end[ss::x]);
    CHECK(mirrored[ss::tx] == end[ss::tx]);
    CHECK(mirrored[ss::y] == -end[ss::y]);
    CHECK(mirrored[ss::ty] == -end[ss::ty]);
  });
}

TEST_CASE("a positive particle along the field turns clockwise seen against it", "[track_model]") {
  // F = q v x B: with v along x and B along z the force points along -y.
  const vector<double, 5> start(0.0, 0.1, 0.0, 0.0, 1.0 / 200.0);
  CHECK(helix_propagator{4.0 * units::tesla}.propagate(start, 10.0).state[ss::y] < 0.0);
}

TEST_CASE("the radius is pt over charge times field and the momentum keeps its size", "[track_model]") {
  for_each_flight([](int, int travel, double field, double dz, const vector<double, 5>& start) {
    const helix_propagator helix{field};
    const double pt = std::hypot(start[ss::tx], start[ss::ty]) / std::abs(start[ss::q_over_pz]);
    // Circle through three points of the path, a third of a turn apart: radius = product of the sides over four times the area.
    const double third = 2.0 * constants::pi / 3.0 / std::abs(field * start[ss::q_over_pz]);
    std::array<vector<double, 2>, 3> point;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = helix.propagate(start, third * static_cast<double>(i)).state;
      point[i] = {at[ss::x], at[ss::y]};
    }
    const vector<double, 2> a = point[1] - point[0], b = point[2] - point[0], c = point[2] - point[1];
    const double radius = a.norm() * b.norm() * c.norm() / (2.0 * std::abs(a[0] * b[1] - a[1] * b[0]));
    CHECK(radius == Approx(pt / std::abs(field)).epsilon(1e-12));

    const auto end = slopes_to_momentum(helix.propagate(start, dz).state, travel).state;
    const auto begin = slopes_to_momentum(start, travel).state;
    CHECK(end.tail<3>().norm() == Approx(begin.tail<3>().norm()).epsilon(1e-14));
    CHECK(end[momentum_state::pz] == begin[momentum_state::pz]);
  });
}

TEST_CASE("the helix becomes the straight line smoothly as the curvature goes", "[track_model]") {
  const double dz = 1000.0;
  vector<double, 5> start(1.0, 0.3, 2.0, -0.2, 0.005);
  const vector<double, 5> straight(1.0 + 0.3 * dz, 0.3, 2.0 - 0.2 * dz, -0.2, 0.005);
  CHECK((helix_propagator{0.0}.propagate(start, dz).state - straight).norm() < 1e-13);
  for (const double field : {1e-14, 1e-10, 1e-7, 1e-5, 1e-4}) {
    const double theta = field * 0.005 * dz;
    const auto end = helix_propagator{field}.propagate(start, dz).state;
    // To first order x grows by dz theta ty / 2, y falls by dz theta tx / 2; the rest is of second order.
    const double second = dz * theta * theta / 6.0 * 0.37 + 4.0 * eps * 300.0;
    CHECK(std::abs(end[ss::x] - straight[ss::x] - 0.5 * dz * theta * -0.2) <= second);
    CHECK(std::abs(end[ss::y] - straight[ss::y] + 0.5 * dz * theta * 0.3) <= second);
  }
  // No curvature at all: the column of q/pz is the slope of that first order, in a full field.
  start[ss::q_over_pz] = 0.0;
  const auto flat = helix_propagator{1.2}.propagate(start, dz);
  CHECK(flat.state.allFinite());
  CHECK(flat.jacobian(ss::x, ss::q_over_pz) == Approx(0.5 * dz * 1.2 * dz * -0.2).epsilon(1e-14));
  CHECK(flat.jacobian(ss::y, ss::q_over_pz) == Approx(-0.5 * dz * 1.2 * dz * 0.3).epsilon(1e-14));
  CHECK(flat.jacobian(ss::tx, ss::q_over_pz) == Approx(1.2 * dz * -0.2).epsilon(1e-14));
}

TEST_CASE("state and Jacobian are continuous where the series hands over to the closed form", "[track_model]") {
  const double dz = 350.0, field = 1.2;
  const double k = 0.5 / (field * dz);
  const auto at = [&](double factor) { return helix_propagator{field}.propagate(vector<double, 5>(1.0, 0.3, 2.0, -0.2, k * factor), dz); };
  const auto below = at(1.0 - 4.0 * eps), above = at(1.0 + 4.0 * eps);
  CHECK((below.state - above.state).cwiseAbs().maxCoeff() < 16.0 * eps * 350.0);
  CHECK(test::deviation<5, 5>(below.jacobian, above.jacobian, slope_units, slope_units) < 1e3 * eps);
}

TEST_CASE("both helices are the same flight in different coordinates", "[track_model]") {
  for_each_flight([](int, int travel, double field, double dz, const vector<double, 5>& start) {
    const auto in = slopes_to_helix(start, travel);
    const auto flown = momentum_helix_propagator{field, travel}.propagate(in.state, dz);
    const auto out = helix_to_slopes(flown.state, travel);
    const auto direct = helix_propagator{field}.propagate(start, dz);
    CHECK(((out.state - direct.state).array() / slope_units.array()).abs().maxCoeff() < 1e3 * eps);
    const matrix<double, 5, 5> chained = out.jacobian * flown.jacobian * in.jacobian;
    CHECK(test::deviation<5, 5>(chained, direct.jacobian, slope_units, slope_units) < 1e4 * eps);
  });
}

TEST_CASE("without curvature the momentum helix runs along z", "[track_model]") {
  const vector<double, 5> start(1.0, 20.0, 2.0, -30.0, 0.0);
  const auto end = momentum_helix_propagator{1.2, 1}.propagate(start, 500.0);
  CHECK(end.state == start);
  CHECK(end.jacobian.allFinite());
}

TEST_CASE("in single precision the helix errs by its rounding", "[track_model]") {
  for_each_flight([](int, int, double field, double dz, const vector<double, 5>& start) {
    const vector<float, 5> rounded = start.cast<float>();
    const auto exact = helix_propagator{field}.propagate(vector<double, 5>(rounded.cast<double>()), dz);
    const auto got = helix_propagator{field}.propagate(rounded, dz);
    // The angle is rounded by |theta| eps, a lever of the whole path; all else is a handful of roundings of the terms.
    const double single = std::numeric_limits<float>::epsilon();
    const double theta = std::abs(field * dz * start[ss::q_over_pz]);
    const double slope = std::hypot(start[ss::tx], start[ss::ty]);
    const double position = single * (40.0 + std::abs(dz) * slope * (8.0 + 2.0 * theta));
    CHECK(std::abs(static_cast<double>(got.state[ss::x]) - exact.state[ss::x]) < position);
    CHECK(std::abs(static_cast<double>(got.state[ss::y]) - exact.state[ss::y]) < position);
    CHECK(std::abs(static_cast<double>(got.state[ss::tx]) - exact.state[ss::tx]) < single * slope * (4.0 + 2.0 * theta));
    const double column = single * std::abs(field * dz * dz) * slope * (16.0 + 4.0 * theta);
    CHECK(std::abs(static_cast<double>(got.jacobian(ss::x, ss::q_over_pz)) - exact.jacobian(ss::x, ss::q_over_pz)) < column);
  });
}
