// SPDX-License-Identifier: MPL-2.0
#include <scifi/track_model/energy_loss_propagator.hpp>

#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <scifi/core/units.hpp>
#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/process_noise.hpp>
#include <scifi/kalman/site.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/materials.hpp>
#include <scifi/track_model/conversions.hpp>
#include <scifi/track_model/fibre_measurement.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/line_propagator.hpp>

#include "dual.hpp"
#include "lorentz.hpp"
#include "support/catch.hpp"

using namespace scifi;
using ss = slope_state;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double field = 3.0 * units::tesla;
const helix_propagator flight{field};
const vector<double, 5> slope_units(1.0, 0.01, 1.0, 0.01, 1e-4);

double momentum_of(const vector<double, 5>& v) { return std::hypot(1.0, v[ss::tx], v[ss::ty]) / std::abs(v[ss::q_over_pz]); }

vector<double, 5> muon(double p, int charge, int travel) {
  const double tx = 0.21, ty = -0.13;
  return {12.0, tx, -34.0, ty, charge * travel * std::hypot(1.0, tx, ty) / p};
}

/// Two thin stacks and gas between, in one direction.
leg between_planes(int direction) {
  leg step{direction * 200.0, direction, {}, {}, {}};
  step.start.add(whole(materials::polystyrene, 0.314)).add(whole(materials::mylar, 0.025));
  step.gap.add(whole(materials::air, 199.0));
  step.finish.add(whole(materials::polystyrene, 0.627)).add(whole(materials::aluminium, 0.1));
  return step;
}

/// The same leg walked from its other end.
leg reversed(const leg& step) { return {-step.dz, -step.direction, step.finish, step.gap, step.start}; }

template <class Check>
void for_each_loss(Check check) {
  check(no_energy_loss{}, "none");
  check(mean_energy_loss{}, "mean");
  check(most_probable_energy_loss{15.0}, "most probable");
  check(median_energy_loss{}, "median");
}

template <class Check>
void for_each_way(Check check) {
  for (const int charge : {+1, -1})
    for (const int travel : {+1, -1})
      for (const int direction : {+1, -1}) {
        INFO("charge " << charge << " travel " << travel << " step " << direction);
        check(charge, travel, direction);
      }
}

}  // namespace

TEST_CASE("the Jacobian with energy loss is that of dual numbers for every policy, way and place of the material", "[track_model]") {
  for_each_loss([](const auto& loss, const char* name) {
    INFO(name);
    for_each_way([&](int charge, int travel, int direction) {
      const energy_loss_propagator model{flight, loss, muon_plus, travel};
      const leg whole_leg = between_planes(direction);
      leg only_start = whole_leg, only_gap = whole_leg, only_finish = whole_leg;
      only_start.gap = {}, only_start.finish = {};
      only_gap.start = only_gap.finish = {};
      only_finish.start = {}, only_finish.gap = {};
      for (const leg& step : {whole_leg, only_start, only_gap, only_finish})
        for (const double p : {60.0, 200.0}) {
          const vector<double, 5> start = muon(p, charge, travel);
          const auto end = model.propagate(start, step);
          const auto expected = test::derivative<5, 5>([&](const auto& v) { return model.propagate(v, step).state; }, start);
          CHECK(test::deviation<5, 5>(end.jacobian, expected, slope_units, slope_units) < 1e4 * eps);
        }
    });
  });
}

TEST_CASE("without energy loss the material does not show", "[track_model]") {
  for_each_way([](int charge, int travel, int direction) {
    const vector<double, 5> start = muon(180.0, charge, travel);
    const leg step = between_planes(direction);
    const auto end = energy_loss_propagator{flight, no_energy_loss{}, muon_plus, travel}.propagate(start, step);
    const auto bare = flight.propagate(start, step.dz);
    CHECK(end.state == bare.state);
    CHECK(end.jacobian == bare.jacobian);
  });
}

TEST_CASE("a leg without material is the bare flight to the last bit", "[track_model]") {
  const vector<double, 5> start = muon(180.0, -1, +1);
  const leg step{-350.0, -1, {}, {}, {}};
  const auto end = energy_loss_propagator{flight, mean_energy_loss{}, muon_plus, +1}.propagate(start, step);
  const auto bare = flight.propagate(start, step.dz);
  CHECK(end.state == bare.state);
  CHECK(end.jacobian == bare.jacobian);
}

TEST_CASE("momentum is lost along the flight and gained against it; charge and direction stay", "[track_model]") {
  for_each_way([](int charge, int travel, int direction) {
    const energy_loss_propagator model{flight, mean_energy_loss{}, muon_plus, travel};
    const vector<double, 5> start = muon(200.0, charge, travel);
    const auto end = model.propagate(start, between_planes(direction)).state;
    CHECK((momentum_of(end) < 200.0) == (direction == travel));
    CHECK(std::abs(momentum_of(end) - 200.0) > 0.2);
    CHECK(end[ss::q_over_pz] * start[ss::q_over_pz] > 0.0);
    CHECK(std::hypot(end[ss::tx], end[ss::ty]) == Approx(std::hypot(start[ss::tx], start[ss::ty])).epsilon(1e-14));
  });
}

TEST_CASE("a leg of no length still has its thin material, along or against the flight as its direction says", "[track_model]") {
  leg step{0.0, -1, {}, {}, {}};
  step.start.add(whole(materials::polystyrene, 0.627));
  const vector<double, 5> start = muon(200.0, +1, -1);
  CHECK(momentum_of(energy_loss_propagator{flight, mean_energy_loss{}, muon_plus, -1}.propagate(start, step).state) < 200.0);
  step.direction = +1;
  CHECK(momentum_of(energy_loss_propagator{flight, mean_energy_loss{}, muon_plus, -1}.propagate(start, step).state) > 200.0);
}

TEST_CASE("there and back gives the momentum again to first order in the loss", "[track_model]") {
  for_each_way([](int charge, int travel, int direction) {
    const energy_loss_propagator model{flight, mean_energy_loss{}, muon_plus, travel};
    const vector<double, 5> start = muon(150.0, charge, travel);
    leg step{direction * 0.6, direction, {}, {}, {}};
    step.start.add(whole(materials::polystyrene, 0.6));
    const auto there = model.propagate(start, step).state;
    const auto back = model.propagate(there, reversed(step)).state;
    // The way back takes the loss at the momentum that the way there left, so L(p1) - L(p0) = L'(p) (p1 - p0) of energy is missing.
    const double path = std::hypot(1.0, start[ss::tx], start[ss::ty]);
    const auto loss = mean_energy_loss{}.loss(150.0, muon_plus, step.start[0], path);
    const double velocity = 150.0 / std::hypot(150.0, muon_plus.mass);
    const double change = momentum_of(there) - 150.0;
    const double missing = loss.d_value_d_p * change / velocity * (direction == travel ? 1.0 : -1.0);
    REQUIRE(std::abs(change) > 20.0 * std::abs(missing));
    CHECK(momentum_of(back) - 150.0 == Approx(missing).epsilon(5.0 * std::abs(change) / 150.0));
  });
}

TEST_CASE("the loss in a station agrees with the integral of Bethe's formula along the path", "[track_model]") {
  // Three fibre planes one behind the other; the momentum falls continuously in the reference, slab by slab in the model.
  const double plane = 0.6273;
  leg step{3.0 * plane, 1, {}, {}, {}};
  for (int i = 0; i < 3; ++i) step.finish.add(whole(materials::polystyrene, plane));
  const auto rate = [](double p, double) {
    return mean_energy_loss_rate(p, muon_plus, materials::polystyrene).value * std::hypot(p, muon_plus.mass) / p;  // dp/ds = E/p dE/ds
  };
  for (const double p : {120.0, 200.0, 286.8}) {
    INFO("p " << p);
    const vector<double, 5> start = muon(p, +1, +1);
    const auto end = energy_loss_propagator{flight, mean_energy_loss{}, muon_plus, +1}.propagate(start, step).state;
    const auto q = slopes_to_momentum(start, +1).state;
    const test::moving particle{{q[0], q[1], 0.0}, {q[2], q[3], q[4]}, 1.0};
    const test::moving reference = test::carried_to(particle, step.dz, [](const vector<double, 3>&) { return vector<double, 3>(0.0, 0.0, field); }, rate);
    const double lost = p - reference.momentum.norm();
    // One evaluation at the start of the loss misses half of its change over the station.
    const auto slope = mean_energy_loss_rate(p, muon_plus, materials::polystyrene);
    const double second_order = lost * lost * (std::abs(slope.d_value_d_p / slope.value) + 1.0 / p);
    REQUIRE(second_order < 0.05 * lost);
    CHECK(std::abs(momentum_of(end) - reference.momentum.norm()) < second_order);
    // The field turns during the loss: a relative change of momentum of lost/p on a turning angle of field dz / pz.
    const double turned = field * step.dz / p * lost / p;
    CHECK(std::abs(end[ss::tx] - reference.momentum[0] / reference.momentum[2]) < turned);
    CHECK(std::abs(end[ss::ty] - reference.momentum[1] / reference.momentum[2]) < turned);
    CHECK(std::abs(end[ss::x] - reference.position[0]) < turned * step.dz);
  }
}

TEST_CASE("the loss in a station is the one of the published table", "[track_model]") {
  // Muons of 200 MeV in polystyrene: 1.970 MeV cm2/g (ionisation, computed from the inputs of Groom et al. 2001); density 1.060 g/cm3.
  const double p = std::sqrt(200.0 * (200.0 + 2.0 * muon_plus.mass));
  const vector<double, 5> start(0.0, 0.0, 0.0, 0.0, 1.0 / p);
  leg step{1.8819, 1, {}, {}, {}};
  for (int i = 0; i < 3; ++i) step.finish.add(whole(materials::polystyrene, 0.6273));
  const double p_end = 1.0 / energy_loss_propagator{flight, mean_energy_loss{}, muon_plus, +1}.propagate(start, step).state[ss::q_over_pz];
  const double lost = std::hypot(p, muon_plus.mass) - std::hypot(p_end, muon_plus.mass);
  CHECK(lost == Approx(1.970 * 1.060 * 0.18819).epsilon(3e-3));
}

TEST_CASE("the column of q/pz of a leg with loss, charge conjugated in the opposite field, is the same", "[track_model]") {
  const vector<double, 5> start = muon(120.0, +1, +1);
  vector<double, 5> conjugate = start;
  conjugate[ss::q_over_pz] *= -1.0;
  const auto plus = energy_loss_propagator{flight, mean_energy_loss{}, muon_plus, +1}.propagate(start, between_planes(+1));
  const auto minus = energy_loss_propagator{helix_propagator{-field}, mean_energy_loss{}, muon_minus, +1}.propagate(conjugate, between_planes(+1));
  CHECK(minus.state.head<4>() == plus.state.head<4>());
  CHECK(minus.state[ss::q_over_pz] == -plus.state[ss::q_over_pz]);
  CHECK(minus.jacobian(ss::x, ss::q_over_pz) == -plus.jacobian(ss::x, ss::q_over_pz));
  CHECK(minus.jacobian(ss::q_over_pz, ss::q_over_pz) == plus.jacobian(ss::q_over_pz, ss::q_over_pz));
}

TEST_CASE("a particle that stops says so, and the filter keeps the track up to there", "[track_model]") {
  const energy_loss_propagator model{flight, mean_energy_loss{}, muon_plus, +1};
  leg thin{10.0, 1, {}, {}, {}}, wall = thin;
  thin.finish.add(whole(materials::polystyrene, 0.6));
  wall.finish.add(whole(materials::aluminium, 200.0));
  const vector<double, 5> start = muon(120.0, +1, +1);
  CHECK(std::isnan(model.propagate(start, wall).state[ss::q_over_pz]));
  CHECK(model.propagate(start, wall).state.head<4>().allFinite());

  const kalman::filter fit{model, kalman::no_noise{}};
  const fibre_measurement<slope_state> fibre{12.0, 1.0, 1.0, 0.0, 0.0};
  const std::vector<kalman::site<leg, fibre_measurement<slope_state>>> sites{{thin, fibre}, {thin, fibre}, {wall, fibre}, {thin, fibre}};
  std::vector<kalman::node<double, 5, 1>> nodes(sites.size());
  const auto prior = kalman::uncorrelated(start, vector<double, 5>(1.0, 0.01, 1.0, 0.01, 1e-4));
  const auto result = fit.run(prior, sites, nodes);
  CHECK(result.status == kalman::status{kalman::step_kind::predict, kalman::reason::not_finite});
  CHECK(result.reached == 2);
  CHECK(result.failed_at == 2);
  CHECK(result.ndf == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(nodes[i].status.ok());
    CHECK(nodes[i].filtered.mean.allFinite());
    CHECK(nodes[i].filtered.covariance.allFinite());
  }
  const auto failed = fit.predict(nodes[1].filtered, wall);
  CHECK(failed.estimate.mean == nodes[1].filtered.mean);
}

TEST_CASE("in single precision a leg with loss errs by its rounding", "[track_model]") {
  const double single = std::numeric_limits<float>::epsilon();
  for_each_loss([single](const auto& loss, const char* name) {
    INFO(name);
    const energy_loss_propagator model{flight, loss, muon_plus, +1};
    const vector<float, 5> start = muon(200.0, +1, +1).template cast<float>();
    const auto exact = model.propagate(vector<double, 5>(start.cast<double>()), between_planes(+1));
    const auto got = model.propagate(start, between_planes(+1));
    const vector<double, 5> end = got.state.template cast<double>();
    // Positions below 100 mm, slopes below 0.3; p^2 of the loss doubles a rounding, a few of them meet.
    CHECK(std::abs(end[ss::x] - exact.state[ss::x]) < 16.0 * single * 100.0);
    CHECK(std::abs(end[ss::y] - exact.state[ss::y]) < 16.0 * single * 100.0);
    CHECK(std::abs(end[ss::tx] - exact.state[ss::tx]) < 16.0 * single * 0.3);
    CHECK(std::abs(end[ss::q_over_pz] / exact.state[ss::q_over_pz] - 1.0) < 16.0 * single);
    CHECK(got.jacobian.allFinite());
    CHECK(got.jacobian(ss::x, ss::q_over_pz) == Approx(exact.jacobian(ss::x, ss::q_over_pz)).epsilon(64.0 * single));
  });
}

TEST_CASE("the legs of a straight track count their distance alone", "[track_model]") {
  const leg_propagator model{line_propagator{}};
  CHECK(model.transition(between_planes(-1)) == line_propagator{}.transition(-200.0));
}
