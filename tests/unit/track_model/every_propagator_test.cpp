// SPDX-License-Identifier: MPL-2.0
// The laws of flight, asked of every propagator alike: each is flown as the span of z that its model turns into its own kind of step.
#include <Eigen/LU>

#include <cmath>
#include <limits>

#include <scifi/core/units.hpp>
#include <scifi/field/graded_field.hpp>
#include <scifi/field/uniform_field.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/materials.hpp>
#include <scifi/track_model/conversions.hpp>
#include <scifi/track_model/energy_loss_propagator.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/line_propagator.hpp>
#include <scifi/track_model/nystrom_propagator.hpp>

#include "dual.hpp"
#include "laws/propagator_laws.hpp"
#include "support/catch.hpp"

using namespace scifi;
using ss = slope_state;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double three_tesla = 3.0 * units::tesla;
const vector<double, 5> slope_units(1.0, 0.01, 1.0, 0.01, 1e-4);
const vector<double, 5> helix_units(1.0, 2.0, 1.0, 2.0, 1e-4);

struct span_of_z {
  double from, to;
};

/// Any propagator over a span of z, with the material of a leg where it takes one.
template <class Flight>
struct flown_over {
  Flight flight;
  leg matter{};
  template <class State>
  [[nodiscard]] auto propagate(const State& start, const span_of_z& s) const {
    const double dz = s.to - s.from;
    if constexpr (requires { flight.field.with_gradient(vector<double, 3>()); }) return flight.propagate(start, stretch{s.from, dz});
    else if constexpr (requires { flight.loss; }) {
      leg step = matter;
      step.z = s.from;
      step.dz = dz;
      step.direction = dz < 0.0 ? -1 : 1;
      return flight.propagate(start, step);
    } else return kalman::propagate(flight, start, dz);
  }
};
template <class Flight>
flown_over(Flight) -> flown_over<Flight>;
template <class Flight>
flown_over(Flight, leg) -> flown_over<Flight>;

/// Steps of a fixed length: the state is a smooth function of the start, which finite differences ask for.
constexpr nystrom_options even_steps{1e9, 20.0, 4096};
/// Steps so fine that flights cut in different places meet.
constexpr nystrom_options fine{1e-8, 50.0, 1 << 16};

template <class Field>
auto nystrom(const Field& field, const nystrom_options& options) { return flown_over{nystrom_propagator<Field>{field, options}}; }

const uniform_field inclined{{0.05, -0.08, three_tesla}};
const graded_field graded{three_tesla, 1e-3 * units::tesla};
constexpr span_of_z flights[]{{0.0, 0.65}, {-40.0, 310.0}, {310.0, -40.0}, {0.0, 800.0}};

vector<double, 5> muon(double pz, int charge, int travel) { return {20.0, 0.21, -30.0, -0.13, charge * travel / pz}; }

/// Both charges and directions of travel.
template <class Check>
void for_each_muon(const Check& check) {
  for (const int charge : {1, -1})
    for (const int travel : {1, -1}) check(muon(150.0, charge, travel), travel);
}

/// Jacobian = dual numbers = finite differences.
template <class Model, int N>
void check_jacobian(const Model& model, const vector<double, N>& start, const vector<double, N>& units, const span_of_z& s, double roundings) {
  const auto moved = model.propagate(start, s);
  // Lever arms reach 1e3 mm and columns of q/pz 1e6 mm (MeV/c), a few roundings of such terms in each step.
  const auto exact = test::derivative<N, N>([&](const auto& v) { return model.propagate(v, s).state; }, start);
  CHECK(test::deviation<N, N>(moved.jacobian, exact, units, units) < roundings * 1e3 * eps);
  const auto found = laws::jacobian_against_differences(model, start, s, 1e-2, units, roundings);
  CHECK(found.deviation_over_error < 1.0);
  CHECK(found.error < 1e-3);  // of columns that reach 1e3
}

/// f(a + b) = f(b) after f(a), past the end and back too; there and back is nothing.
template <class Model, int N>
void check_path(const Model& model, const vector<double, N>& start, const span_of_z& s, double tolerance) {
  const auto at = [&](double share) { return s.from + share * (s.to - s.from); };
  for (const double cut : {0.3, 1.4}) CHECK(laws::composition_deviation(model, start, span_of_z{s.from, at(cut)}, span_of_z{at(cut), s.to}, s) < tolerance);
  CHECK(laws::round_trip_deviation(model, start, s, span_of_z{s.to, s.from}) < tolerance);
  const auto still = model.propagate(start, span_of_z{s.from, s.from});
  CHECK((still.state - start).cwiseAbs().maxCoeff() < 4.0 * eps * 30.0);
  CHECK((still.jacobian - matrix<double, N, N>::Identity()).cwiseAbs().maxCoeff() < 4.0 * eps);
}

/// Liouville: dx dpx dy dpy stays at fixed |p|. dtx dty = p^2/pz^4 dpx dpy and q/pz = (q/p) p/pz, so the determinant in slopes is (pz / pz')^5.
template <class Model>
void check_volume_in_slopes(const Model& model, const vector<double, 5>& start, const span_of_z& s, double tolerance) {
  const auto moved = model.propagate(start, s);
  CHECK(moved.jacobian.determinant() == Approx(std::pow(moved.state[ss::q_over_pz] / start[ss::q_over_pz], 5)).epsilon(tolerance));
}

const matrix<double, 5, 5> conjugation = vector<double, 5>(1.0, 1.0, 1.0, 1.0, -1.0).asDiagonal();
const matrix<double, 5, 5> mirror_of_y = vector<double, 5>(1.0, 1.0, -1.0, -1.0, 1.0).asDiagonal();

/// Start and end turned by S, in two models that S turns into one another: the same flight, to the last bit, state and Jacobian.
template <class Model>
void check_same_flight(const Model& model, const Model& turned, const matrix<double, 5, 5>& s, const vector<double, 5>& start, const span_of_z& way) {
  const auto a = model.propagate(start, way);
  const auto b = turned.propagate(vector<double, 5>(s * start), way);
  CHECK(b.state == vector<double, 5>(s * a.state));
  CHECK((b.jacobian - s * a.jacobian * s).norm() == 0.0);
}

/// As the field goes the flight goes to `straight`, and as the field itself: a thousandth of it leaves a thousandth of the bend.
template <class Make>
void check_straight_limit(const Make& make, const vector<double, 5>& start, const vector<double, 5>& straight, const span_of_z& s) {
  CHECK((make(0.0).propagate(start, s).state - straight).cwiseAbs().maxCoeff() < 16.0 * eps * 300.0);
  const auto bend = [&](double scale) -> vector<double, 2> {
    const auto end = make(scale).propagate(start, s).state;
    return {end[ss::x] - straight[ss::x], end[ss::y] - straight[ss::y]};
  };
  const vector<double, 2> weak = bend(1e-3), weaker = bend(1e-6);
  // Turning angles of 1e-2 rad and below: the next order is that part of the first.
  REQUIRE(weak.norm() > 0.05);
  CHECK((weak - 1e3 * weaker).norm() < 1e-2 * weak.norm());
}

vector<double, 5> line_in_slopes(const vector<double, 5>& v, double dz) {
  return {v[ss::x] + dz * v[ss::tx], v[ss::tx], v[ss::y] + dz * v[ss::ty], v[ss::ty], v[ss::q_over_pz]};
}

}  // namespace

TEST_CASE("the Jacobian of every propagator is that of dual numbers and of finite differences", "[track_model]") {
  leg matter;
  matter.start.add(whole(materials::polystyrene, 0.6));
  matter.gap.add(whole(materials::air, 300.0));
  matter.finish.add(whole(materials::aluminium, 0.3));
  for (const span_of_z& s : flights) {
    INFO("from " << s.from << " to " << s.to);
    check_jacobian(flown_over{line_propagator{}}, vector<double, 4>(20.0, 0.21, -30.0, -0.13), vector<double, 4>(1.0, 0.01, 1.0, 0.01), s, 1e1);
    for_each_muon([&](const vector<double, 5>& start, int travel) {
      check_jacobian(flown_over{helix_propagator{three_tesla}}, start, slope_units, s, 1e1);
      check_jacobian(flown_over{momentum_helix_propagator{three_tesla, travel}}, slopes_to_helix(start, travel).state, helix_units, s, 1e1);
      check_jacobian(nystrom(inclined, even_steps), start, slope_units, s, 1e3);
      check_jacobian(nystrom(graded, even_steps), start, slope_units, s, 1e3);
      check_jacobian(flown_over{energy_loss_propagator{helix_propagator{three_tesla}, mean_energy_loss{}, muon_plus, travel}, matter}, start, slope_units, s, 1e2);
      check_jacobian(flown_over{energy_loss_propagator{nystrom_propagator{graded, even_steps}, median_energy_loss{}, muon_plus, travel}, matter}, start, slope_units, s, 1e3);
    });
  }
}

TEST_CASE("every flight may be cut anywhere, undone, and keeps the volume of phase space", "[track_model]") {
  for (const span_of_z& s : flights) {
    INFO("from " << s.from << " to " << s.to);
    const vector<double, 4> line(20.0, 0.21, -30.0, -0.13);
    check_path(flown_over{line_propagator{}}, line, s, 1e1 * eps);
    CHECK(flown_over{line_propagator{}}.propagate(line, s).jacobian.determinant() == Approx(1.0).epsilon(1e2 * eps));
    for_each_muon([&](const vector<double, 5>& start, int travel) {
      const flown_over helix{helix_propagator{three_tesla}};
      check_path(helix, start, s, 1e3 * eps);
      check_volume_in_slopes(helix, start, s, 1e4 * eps);
      const flown_over momenta{momentum_helix_propagator{three_tesla, travel}};
      const vector<double, 5> same = slopes_to_helix(start, travel).state;
      check_path(momenta, same, s, 1e3 * eps);
      CHECK(momenta.propagate(same, s).jacobian.determinant() == Approx(1.0).epsilon(1e5 * eps));
      // Steps within 1e-8 mm of some tens of mm; levers as for the Jacobian.
      check_path(nystrom(inclined, fine), start, s, 1e-8);
      check_path(nystrom(graded, fine), start, s, 1e-8);
      check_volume_in_slopes(nystrom(inclined, fine), start, s, 1e-7);
      check_volume_in_slopes(nystrom(graded, fine), start, s, 1e-7);
    });
  }
}

TEST_CASE("the opposite charge in the opposite field flies the same way, in every propagator", "[track_model]") {
  for (const span_of_z& s : flights)
    for_each_muon([&](const vector<double, 5>& start, int travel) {
      check_same_flight(flown_over{helix_propagator{three_tesla}}, flown_over{helix_propagator{-three_tesla}}, conjugation, start, s);
      check_same_flight(flown_over{momentum_helix_propagator{three_tesla, travel}}, flown_over{momentum_helix_propagator{-three_tesla, travel}}, conjugation,
                        slopes_to_helix(start, travel).state, s);
      check_same_flight(nystrom(inclined, {}), nystrom(uniform_field{-inclined.value}, {}), conjugation, start, s);
      check_same_flight(nystrom(graded, {}), nystrom(graded_field{-graded.field, -graded.gradient}, {}), conjugation, start, s);
    });
}

TEST_CASE("a flight seen in a mirror is a flight in the mirrored field, in every propagator", "[track_model]") {
  // B is axial: the mirror y -> -y turns (Bx, By, Bz) into (-Bx, By, -Bz), and a field about the z axis into its opposite.
  const vector<double, 3> b = inclined.value;
  for (const span_of_z& s : flights)
    for_each_muon([&](const vector<double, 5>& start, int travel) {
      check_same_flight(flown_over{helix_propagator{three_tesla}}, flown_over{helix_propagator{-three_tesla}}, mirror_of_y, start, s);
      check_same_flight(flown_over{momentum_helix_propagator{three_tesla, travel}}, flown_over{momentum_helix_propagator{-three_tesla, travel}}, mirror_of_y,
                        slopes_to_helix(start, travel).state, s);
      check_same_flight(nystrom(inclined, {}), nystrom(uniform_field{{-b.x(), b.y(), -b.z()}}, {}), mirror_of_y, start, s);
      check_same_flight(nystrom(graded, {}), nystrom(graded_field{-graded.field, -graded.gradient}, {}), mirror_of_y, start, s);
    });
}

TEST_CASE("a flight in a field about the z axis turns with its start", "[track_model]") {
  const double c = std::cos(0.7), d = std::sin(0.7);
  matrix<double, 5, 5> turn = matrix<double, 5, 5>::Identity();
  for (const int i : {ss::x, ss::tx}) {
    turn(i, i) = turn(i + 2, i + 2) = c;
    turn(i, i + 2) = -d;
    turn(i + 2, i) = d;
  }
  const auto check = [&](const auto& model, const vector<double, 5>& start, const vector<double, 5>& units, const span_of_z& s) {
    const auto a = model.propagate(start, s);
    const auto b = model.propagate(vector<double, 5>(turn * start), s);
    CHECK(((b.state - turn * a.state).array() / units.array()).abs().maxCoeff() < 1e5 * eps);
    CHECK(test::deviation<5, 5>(b.jacobian, turn * a.jacobian * turn.transpose(), units, units) < 1e6 * eps);
  };
  for (const span_of_z& s : flights)
    for_each_muon([&](const vector<double, 5>& start, int travel) {
      check(flown_over{helix_propagator{three_tesla}}, start, slope_units, s);
      check(flown_over{momentum_helix_propagator{three_tesla, travel}}, slopes_to_helix(start, travel).state, helix_units, s);
      check(nystrom(graded, even_steps), start, slope_units, s);
    });
}

TEST_CASE("every flight becomes the straight line as the field goes, in proportion to it", "[track_model]") {
  const span_of_z s{-40.0, 310.0};
  for_each_muon([&](const vector<double, 5>& start, int travel) {
    const vector<double, 5> straight = line_in_slopes(start, 350.0);
    check_straight_limit([](double scale) { return flown_over{helix_propagator{scale * three_tesla}}; }, start, straight, s);
    check_straight_limit([](double scale) { return nystrom(uniform_field{scale * inclined.value}, fine); }, start, straight, s);
    check_straight_limit([](double scale) { return nystrom(graded_field{scale * graded.field, scale * graded.gradient}, fine); }, start, straight, s);
    check_straight_limit([&](double scale) { return flown_over{momentum_helix_propagator{scale * three_tesla, travel}}; }, slopes_to_helix(start, travel).state,
                         slopes_to_helix(straight, travel).state, s);
  });
}

TEST_CASE("a leg may be cut where its material is not, and thick material to first order in the loss", "[track_model]") {
  for_each_muon([](const vector<double, 5>& start, int travel) {
    const energy_loss_propagator model{helix_propagator{three_tesla}, mean_energy_loss{}, muon_plus, travel};
    leg first{120.0, 1, {}, {}, {}}, last{230.0, 1, {}, {}, {}};
    first.start.add(whole(materials::polystyrene, 0.6));
    leg all{350.0, 1, first.start, {}, {}};
    CHECK(laws::composition_deviation(model, start, first, last, all) < 1e3 * eps);
    first.start = {};
    last.finish.add(whole(materials::aluminium, 0.4));
    all = {350.0, 1, {}, {}, last.finish};
    CHECK(laws::composition_deviation(model, start, first, last, all) < 1e3 * eps);

    // Each leg takes its loss at its start, which misses half of the change over the leg: twice the legs miss half as much.
    const auto momentum_after = [&](int legs) {
      const double each = 80.0 / legs;
      vector<double, 5> v = start;
      for (int i = 0; i < legs; ++i) {
        leg part{travel * each, travel, {}, {}, {}};
        part.gap.add(whole(materials::polystyrene, each));
        v = model.propagate(v, part).state;
      }
      return std::hypot(1.0, v[ss::tx], v[ss::ty]) / std::abs(v[ss::q_over_pz]);
    };
    const double coarse = momentum_after(16), middle = momentum_after(32), fine_cut = momentum_after(64);
    REQUIRE(std::abs(coarse - middle) > 0.01);
    CHECK((coarse - middle) / (middle - fine_cut) == Approx(2.0).margin(0.1));
  });
}

TEST_CASE("a leg with loss shrinks phase space by as much as the loss says", "[track_model]") {
  // Material at the end leaves the slopes alone: the determinant of the leg is d(q/pz)'/d(q/pz) = (p/p')^2 dp'/dp, with E' = E - L(p).
  for_each_muon([](const vector<double, 5>& start, int travel) {
    leg step{travel * 350.0, travel, {}, {}, {}};
    step.finish.add(whole(materials::aluminium, 3.0));
    const auto moved = energy_loss_propagator{helix_propagator{three_tesla}, mean_energy_loss{}, muon_plus, travel}.propagate(start, step);
    const double path = std::hypot(1.0, start[ss::tx], start[ss::ty]);
    const double p = path / std::abs(start[ss::q_over_pz]), energy = std::hypot(p, muon_plus.mass);
    const auto lost = mean_energy_loss{}.loss(p, muon_plus, step.finish[0], path);
    const double energy_end = energy - lost.value;
    const double p_end = std::sqrt(energy_end * energy_end - muon_plus.mass * muon_plus.mass);
    const double slope = energy_end / p_end * (p / energy - lost.d_value_d_p);
    CHECK(slope > 1.005);  // slow particles lose more
    CHECK(moved.jacobian.determinant() == Approx(p * p / (p_end * p_end) * slope).epsilon(1e5 * eps));
  });
}
