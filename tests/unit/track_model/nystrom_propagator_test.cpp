// SPDX-License-Identifier: MPL-2.0
#include <scifi/track_model/nystrom_propagator.hpp>

#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <scifi/core/units.hpp>
#include <scifi/field/graded_field.hpp>
#include <scifi/field/uniform_field.hpp>
#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/process_noise.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/materials.hpp>
#include <scifi/track_model/conversions.hpp>
#include <scifi/track_model/energy_loss_propagator.hpp>
#include <scifi/track_model/helix_propagator.hpp>

#include "dual.hpp"
#include "laws/propagator_laws.hpp"
#include "lorentz.hpp"
#include "support/catch.hpp"
#include "unit/kalman/lanes.hpp"

using namespace scifi;
using ss = slope_state;

namespace {

constexpr double three_tesla = 3.0 * units::tesla;
const vector<double, 5> slope_units(1.0, 0.01, 1.0, 0.01, 1e-4);
constexpr nystrom_options fine{1e-8, 50.0, 1 << 16};
const graded_field graded{three_tesla, 1e-3 * units::tesla};

/// A field that ends at a cylinder, as one known from a map.
struct walled_field {
  double radius;
  template <class Scalar>
  vector<Scalar, 3> operator()(const vector<Scalar, 3>& r) const {
    const Scalar b = select(r.x() * r.x() + r.y() * r.y() < Scalar(radius * radius), Scalar(three_tesla), Scalar(std::numeric_limits<double>::quiet_NaN()));
    return {Scalar(0.0), Scalar(0.0), b};
  }
};

/// A field that does not tell its gradient.
struct plain_graded_field {
  template <class Scalar>
  vector<Scalar, 3> operator()(const vector<Scalar, 3>& r) const {
    return graded(r);
  }
};

vector<double, 5> muon(double pz, int charge = 1, int travel = 1) { return {20.0, 0.21 * travel, -30.0, -0.13, charge * travel / pz}; }

test::moving particle_of(const vector<double, 5>& slopes, int travel, int charge, double z) {
  const auto p = slopes_to_momentum(slopes, travel).state;
  return {{p[momentum_state::x], p[momentum_state::y], z}, {p[momentum_state::px], p[momentum_state::py], p[momentum_state::pz]}, double(charge)};
}

double off(const vector<double, 5>& a, const vector<double, 5>& b) { return ((a - b).array() / slope_units.array()).abs().maxCoeff(); }

}  // namespace

TEST_CASE("in a uniform field the flight is the helix to 1e-9, state and Jacobian", "[track_model]") {
  for (const int charge : {1, -1})
    for (const int travel : {1, -1})
      for (const double field : {three_tesla, -4.0 * units::tesla, 0.0})
        for (const double dz : {0.65, 199.3, -350.0, 1100.0})
          for (const double pz : {90.0, 200.0}) {
            INFO("charge " << charge << " travel " << travel << " field " << field << " dz " << dz << " pz " << pz);
            const vector<double, 5> start = muon(pz, charge, travel);
            const auto got = nystrom_propagator{uniform_field{{0.0, 0.0, field}}, fine}.fly(start, {17.0, dz});
            const auto helix = helix_propagator{field}.propagate(start, dz);
            REQUIRE(got.status == flight_status::arrived);
            for (const int i : {ss::x, ss::y}) CHECK(std::abs(got.moved.state[i] - helix.state[i]) < 1e-9 * std::hypot(helix.state[ss::x], helix.state[ss::y]));
            for (const int i : {ss::tx, ss::ty}) CHECK(std::abs(got.moved.state[i] - helix.state[i]) < 1e-9 * std::hypot(helix.state[ss::tx], helix.state[ss::ty]));
            CHECK(got.moved.state[ss::q_over_pz] == Approx(helix.state[ss::q_over_pz]).epsilon(1e-9));
            for (int i = 0; i < 5; ++i) {
              const matrix<double, 5, 5>&a = got.moved.jacobian, &b = helix.jacobian;
              CHECK((a.col(i) - b.col(i)).head<4>().norm() <= 1e-9 * b.col(i).norm() * (i == ss::q_over_pz ? 10.0 : 1.0));
            }
          }
}

TEST_CASE("at the default tolerance a flight of a metre errs by less than a micrometre", "[track_model]") {
  for (const double pz : {120.0, 200.0, 280.0}) {
    const auto got = nystrom_propagator{uniform_field{{0.0, 0.0, three_tesla}}}.fly(muon(pz), {0.0, 1100.0});
    const auto helix = helix_propagator{three_tesla}.propagate(muon(pz), 1100.0);
    CHECK((got.moved.state - helix.state).cwiseAbs().maxCoeff() < 1e-3);
    CHECK(got.steps <= 128);
  }
}

TEST_CASE("in fields that change the flight is the path that the Lorentz force integrates to", "[track_model]") {
  const auto check = [](const auto& field, const char* name) {
    INFO(name);
    for (const int charge : {1, -1})
      for (const int travel : {1, -1})
        for (const double dz : {-350.0, 700.0}) {
          const vector<double, 5> start = muon(180.0, charge, travel);
          const auto end = nystrom_propagator{field, fine}.propagate(start, stretch{100.0, dz}).state;
          const auto reference = test::carried_to(particle_of(start, travel, charge, 100.0), 100.0 + dz, field);
          // Thousands of steps, each within 1e-8 mm by an estimate that is some twenty times too large; levers of up to 7.
          CHECK(std::abs(end[ss::x] - reference.position[0]) < 1e-6);
          CHECK(std::abs(end[ss::y] - reference.position[1]) < 1e-6);
          CHECK(std::abs(end[ss::tx] - reference.momentum[0] / reference.momentum[2]) < 1e-8);
          CHECK(std::abs(end[ss::ty] - reference.momentum[1] / reference.momentum[2]) < 1e-8);
          CHECK(std::abs(end[ss::q_over_pz] * reference.momentum[2] / charge - 1.0) < 1e-8);
        }
  };
  check(graded, "graded");
  check(uniform_field{{0.05, -0.08, three_tesla}}, "uniform, inclined");
}

TEST_CASE("the Jacobian is that of dual numbers through the integrator, the choice of steps included", "[track_model]") {
  for (const int charge : {1, -1})
    for (const double dz : {0.65, 199.3, -350.0, 1100.0})
      for (const double tolerance : {1e-1, 1e-3, 1e-5}) {
        const vector<double, 5> start = muon(150.0, charge);
        const auto check = [&](const auto& flight) {
          const auto moved = flight.propagate(start, stretch{-80.0, dz});
          const auto expected = test::derivative<5, 5>([&](const auto& v) { return flight.propagate(v, stretch{-80.0, dz}).state; }, start);
          // Lever arms of 1e3 and columns of q/pz of 1e6, a rounding in each of some hundred steps.
          CHECK(test::deviation<5, 5>(moved.jacobian, expected, slope_units, slope_units) < 1e6 * std::numeric_limits<double>::epsilon());
        };
        check(nystrom_propagator{graded, nystrom_options{tolerance, 50.0, 4096}});
        check(nystrom_propagator{uniform_field{{0.05, -0.08, three_tesla}}, nystrom_options{tolerance, 50.0, 4096}});
      }
}

TEST_CASE("without a gradient the Jacobian leaves out how the field changes across the track, and nothing else", "[track_model]") {
  const vector<double, 5> start = muon(180.0);
  const auto with = nystrom_propagator{graded}.propagate(start, stretch{0.0, 300.0});
  const auto without = nystrom_propagator{plain_graded_field{}}.propagate(start, stretch{0.0, 300.0});
  CHECK(without.state == with.state);
  CHECK(without.jacobian.col(ss::x) == vector<double, 5>::Unit(ss::x));
  // The field turns about the axis by dBz/dz * lever / 2 against Bz: 1 T/m * 0.15 m / 3 T = 5 %.
  CHECK(test::deviation<5, 5>(with.jacobian, without.jacobian, slope_units, slope_units) > 1e-3);
  CHECK((with.jacobian - without.jacobian).norm() < 0.05 * with.jacobian.norm());
}

TEST_CASE("flights compose, return and stand still over no length", "[track_model]") {
  struct at_z {
    nystrom_propagator<graded_field> flight;
    kalman::propagated<double, 5> propagate(const vector<double, 5>& start, const stretch& way) const { return flight.propagate(start, way); }
  };
  const at_z model{{graded, fine}};
  const vector<double, 5> start = muon(160.0);
  CHECK(laws::composition_deviation(model, start, stretch{0.0, 120.0}, stretch{120.0, 230.0}, stretch{0.0, 350.0}) < 1e-8);
  CHECK(laws::round_trip_deviation(model, start, stretch{0.0, 350.0}, stretch{350.0, -350.0}) < 1e-8);
  const auto still = model.propagate(start, stretch{40.0, 0.0});
  CHECK(off(still.state, start) < 1e-14);
  CHECK((still.jacobian - matrix<double, 5, 5>::Identity()).norm() < 1e-14);
}

TEST_CASE("the straight line is the limit of no field and of no charge over momentum", "[track_model]") {
  vector<double, 5> start = muon(200.0);
  const vector<double, 5> line(20.0 + 210.0, 0.21, -30.0 - 130.0, -0.13, 0.005);
  const auto free = nystrom_propagator{uniform_field{}}.fly(start, {0.0, 1000.0});
  CHECK(off(free.moved.state, line) < 1e-12);
  start[ss::q_over_pz] = 0.0;
  const auto flat = nystrom_propagator{graded}.fly(start, {0.0, 1000.0});
  CHECK(flat.status == flight_status::arrived);
  CHECK(flat.moved.state[ss::x] == Approx(line[ss::x]).epsilon(1e-13));
  CHECK(flat.moved.jacobian.allFinite());
}

TEST_CASE("a track that leaves the field, begins nowhere or turns back says so, and the filter stops there", "[track_model]") {
  const nystrom_propagator inside{walled_field{60.0}};
  CHECK(inside.fly(muon(180.0), {0.0, 20.0}).status == flight_status::arrived);
  const auto outside = inside.fly(muon(180.0), {0.0, 400.0});
  CHECK(outside.status == flight_status::no_field);
  CHECK(std::isnan(outside.moved.state[ss::x]));
  CHECK(std::isnan(outside.moved.state[ss::q_over_pz]));
  CHECK(outside.steps + outside.rejected < 200);

  vector<double, 5> nowhere = muon(180.0);
  nowhere[ss::ty] = std::numeric_limits<double>::quiet_NaN();
  CHECK(inside.fly(nowhere, {0.0, 100.0}).status == flight_status::not_finite);
  for (const double strange : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const auto lost = inside.fly(muon(180.0), {0.0, strange});
    CHECK(lost.status == flight_status::not_finite);
    CHECK(std::isnan(lost.moved.state[ss::x]));
    CHECK(inside.fly(muon(180.0), {strange, 10.0}).status == flight_status::not_finite);
  }
  CHECK(nystrom_propagator{graded}.fly(muon(180.0), {0.0, 1e300}).status != flight_status::arrived);
  CHECK(describe(flight_status::arrived) == "the track arrived");
  CHECK(describe(flight_status::not_finite) == "the track or its way began with a number that is infinite or not a number");
  CHECK(describe(flight_status::no_field) == "the track left the region where the field is known");

  // A transverse field of 3 T turns 50 MeV/c back on a radius of 56 mm.
  const nystrom_propagator across{uniform_field{{three_tesla, 0.0, 0.0}}};
  const auto turned = across.fly(vector<double, 5>(0.0, 0.0, 0.0, 0.0, 1.0 / 50.0), {0.0, 200.0});
  CHECK(turned.status == flight_status::too_many_steps);
  CHECK(std::isnan(turned.moved.state[ss::y]));
  CHECK(describe(turned.status) == "the track needs more steps than allowed");
  CHECK(nystrom_propagator{graded, nystrom_options{1e-9, 1000.0, 8}}.fly(muon(180.0), {0.0, 1000.0}).status == flight_status::too_many_steps);

  const auto failed = kalman::filter{inside, kalman::no_noise{}}.predict(kalman::uncorrelated(muon(180.0), slope_units), stretch{0.0, 400.0});
  CHECK(failed.status == kalman::status{kalman::step_kind::predict, kalman::reason::not_finite});
}

TEST_CASE("a stage beyond the edge of the field is a step too long, not a track that left", "[track_model]") {
  // A circle of radius pt/B about (centre, 0), run clockwise from 40 degrees, that passes 0.1 mm inside of the edge: the tangent leaves at once.
  const double pt = 20.0, edge = 60.0, radius = pt / three_tesla, centre = edge - 0.1 - radius, angle = 40.0 * units::degree;
  const vector<double, 5> start(centre + radius * std::cos(angle), pt / 180.0 * std::sin(angle), radius * std::sin(angle), -pt / 180.0 * std::cos(angle), 1.0 / 180.0);
  const nystrom_options coarse{1000.0, 1000.0, 4096};
  const auto end = nystrom_propagator{walled_field{edge}, coarse}.fly(start, {0.0, 600.0});
  const auto everywhere = nystrom_propagator{uniform_field{{0.0, 0.0, three_tesla}}, coarse}.fly(start, {0.0, 600.0});
  CHECK(end.status == flight_status::arrived);
  CHECK(end.steps > everywhere.steps);
}

TEST_CASE("lanes share their steps, are each right, and one that fails does not stop the others", "[track_model]") {
  const nystrom_propagator flight{graded};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  vector<lanes::pack, 5> start;
  const vector<double, 5> a = muon(180.0), b = muon(90.0, -1), c = muon(250.0);
  for (int i = 0; i < 5; ++i) start[i] = lanes::pack(a[i], b[i], i == ss::tx ? nan : c[i], c[i]);
  const auto together = flight.fly(start, {0.0, 600.0});
  CHECK(together.status == flight_status::arrived);
  CHECK(std::isnan(together.moved.state[ss::x].v[2]));
  const std::array<vector<double, 5>, 4> single{a, b, c, c};
  for (const std::size_t lane : {0u, 1u, 3u}) {
    const auto alone = flight.fly(single[lane], {0.0, 600.0});
    CHECK(alone.steps <= together.steps);
    // Alone it may take longer steps, within the tolerance.
    for (int i = 0; i < 5; ++i) CHECK(std::abs(together.moved.state[i].v[lane] - alone.moved.state[i]) < 1e-3 * slope_units[i]);
    CHECK(together.moved.jacobian(ss::x, ss::q_over_pz).v[lane] == Approx(alone.moved.jacobian(ss::x, ss::q_over_pz)).epsilon(1e-5));
  }
  // The lane whose momentum asks for the shortest steps is flown as if alone.
  for (int i = 0; i < 5; ++i) CHECK(together.moved.state[i].v[1] == flight.fly(b, {0.0, 600.0}).moved.state[i]);
}

TEST_CASE("in single precision a flight errs by its rounding", "[track_model]") {
  const vector<float, 5> start = muon(200.0).cast<float>();
  const auto exact = nystrom_propagator{graded}.propagate(vector<double, 5>(start.cast<double>()), stretch{0.0, 350.0});
  const auto got = nystrom_propagator{graded}.fly(start, {0.0, 350.0});
  REQUIRE(got.status == flight_status::arrived);
  // Some thirty steps with a rounding of numbers of 100 mm each.
  const double single = 30.0 * std::numeric_limits<float>::epsilon();
  CHECK(std::abs(static_cast<double>(got.moved.state[ss::x]) - exact.state[ss::x]) < single * 100.0);
  CHECK(std::abs(static_cast<double>(got.moved.state[ss::ty]) - exact.state[ss::ty]) < single);
  CHECK(got.moved.jacobian(ss::x, ss::q_over_pz) == Approx(exact.jacobian(ss::x, ss::q_over_pz)).epsilon(4.0 * single));
}

TEST_CASE("with energy loss the flight knows where its leg begins", "[track_model]") {
  const energy_loss_propagator model{nystrom_propagator{graded}, mean_energy_loss{}, muon_plus, 1};
  leg step;
  step.z = 400.0;
  step.dz = 200.0;
  CHECK(model.propagate(muon(180.0), step).state == nystrom_propagator{graded}.propagate(muon(180.0), stretch{400.0, 200.0}).state);
  step.gap.add(whole(materials::air, 200.0));
  step.start.add(whole(materials::polystyrene, 0.6));
  const vector<double, 5> start = muon(180.0);
  const auto expected = test::derivative<5, 5>([&](const auto& v) { return model.propagate(v, step).state; }, start);
  CHECK(test::deviation<5, 5>(model.propagate(start, step).jacobian, expected, slope_units, slope_units) < 1e5 * std::numeric_limits<double>::epsilon());
}
