// SPDX-License-Identifier: MPL-2.0
#include <array>
#include <cmath>

#include <scifi/field/cylindrical_map.hpp>
#include <scifi/field/graded_field.hpp>
#include <scifi/kalman/filter.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/materials.hpp>
#include <scifi/material/momentum.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/material/straggling.hpp>
#include <scifi/track_model/energy_loss_propagator.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/material_noise.hpp>
#include <scifi/track_model/nystrom_propagator.hpp>

#include "extreme/extremes.hpp"
#include "support/catch.hpp"

using namespace scifi;
using test::all_finite;
using test::extremes;
using test::infinity;
using test::not_a_number;
using test::sound;

namespace {

constexpr double three_tesla = 3.0 * units::tesla;
const slab millimetre = whole(materials::polystyrene, 1.0);

/// A loss or a variance at any momentum: in the range of the formula not negative and finite, beyond it perhaps not finite, never a number of the wrong sign.
template <class AtMomentum>
void never_negative(const AtMomentum& at) {
  for (const double beta_gamma : {0.02, 0.1, 1.0, 1e3, 1e16, 1e60, 1e140}) {
    INFO(beta_gamma);
    const double value = at(beta_gamma * muon_plus.mass);
    CHECK((std::isfinite(value) && value >= 0.0));
  }
  for (const double p : extremes) {
    INFO(p);
    const double value = at(p);
    if (std::isnan(p)) CHECK(std::isnan(value));
    if (p >= 0.0) CHECK_FALSE(value < 0.0);
  }
}

/// A muon of 200 MeV/c in slopes with one number put out of order: a component of the state, a variance, or the length, thickness or field of a step through plastic.
constexpr int slots = 9, thickness_slot = 7;
template <class Loss, class Straggling>
void never_lies(const Loss& loss, const Straggling& straggling) {
  using s = slope_state;
  for (int slot = 0; slot < slots; ++slot)
    for (const double x : extremes) {
      INFO("slot " << slot << " is " << x);
      kalman::estimate<double, 5> start{vector<double, 5>::Zero(), matrix<double, 5, 5>::Identity()};
      start.mean << 10.0, 0.1, -20.0, 0.2, 0.005;
      start.covariance(s::q_over_pz, s::q_over_pz) = 1e-6;
      double dz = 100.0, thickness = 1.0, field = three_tesla;
      const std::array<double*, slots> at{&start.mean[0], &start.mean[1], &start.mean[2], &start.mean[3], &start.mean[4], &start.covariance(1, 1), &dz, &thickness, &field};
      *at[static_cast<std::size_t>(slot)] = x;
      leg step{dz, 1, {}, {}, {}, 0.0};
      step.finish.add({materials::polystyrene, thickness, 0.0024});
      step.start.add(millimetre);
      const kalman::filter f(energy_loss_propagator{helix_propagator{field}, loss, muon_plus, 1}, material_noise{highland_scattering{}, straggling, muon_plus});
      const auto moved = f.predict(start, step);
      const bool no_matter = slot == thickness_slot && x < 0.0;
      if (!std::isfinite(x) && !no_matter) CHECK_FALSE(moved.status.ok());
      if (moved.status.ok()) CHECK((sound(moved.estimate) && all_finite(moved.jacobian)));
      else CHECK(((moved.estimate.mean - start.mean).isZero(0.0) || !all_finite(start.mean)));
    }
}

}  // namespace

TEST_CASE("no momentum makes a loss or a variance negative, and NaN stays NaN", "[extreme]") {
  const double path = 1.2;
  SECTION("mean loss") {
    never_negative([&](double p) { return mean_energy_loss{}.loss(p, muon_plus, millimetre, path).value; });
    CHECK(std::isnan(mean_energy_loss{}.loss(0.5, muon_plus, millimetre, path).value));  // below where Bethe's formula means something
  }
  SECTION("scattering") { never_negative([&](double p) { return highland_scattering{}.variance(p, muon_plus, millimetre, path); }); }
  SECTION("straggling of all") { never_negative([&](double p) { return bohr_straggling{}.variance(p, muon_plus, millimetre, path); }); }
  SECTION("straggling of the core") { never_negative([&](double p) { return landau_straggling{}.variance(p, muon_plus, millimetre, path); }); }
  for (const double p : {1e-3, 1.0, 1e100, infinity}) CHECK(highland_scattering{}.variance(p, muon_plus, {materials::polystyrene, 0.0, 0.0}, path) == 0.0);
}

TEST_CASE("a thickness that is not a number is not taken for none", "[extreme]") {
  const slab unknown{materials::polystyrene, not_a_number, 0.01};
  slab_stack<4> stack;
  stack.add(unknown);
  const auto crossing = crossing_particle_of(200.0, muon_plus, 1.2);
  CHECK(std::isnan(mean_energy_loss{}.loss(crossing, muon_plus, unknown).value));
  CHECK(std::isnan(median_energy_loss{}.loss(crossing, muon_plus, unknown).value));
  CHECK(std::isnan(most_probable_energy_loss{}.prepared(muon_plus, stack).loss(crossing).value));
  CHECK(std::isnan(highland_scattering{}.variance(200.0, muon_plus, unknown, 1.2)));
  CHECK(std::isnan(highland_scattering{}.variance(crossing, muon_plus, unknown)));
  CHECK(std::isnan(highland_scattering{}.prepared(muon_plus, stack).variance(crossing)));
  CHECK(std::isnan(highland_scattering{}.variance(not_a_number, muon_plus, millimetre, 1.2)));
}

TEST_CASE("a particle that loses any amount has a momentum above zero, or has stopped with NaN", "[extreme]") {
  for (const double p : extremes)
    for (const double loss : extremes) {
      INFO(p << " loses " << loss);
      const auto after = momentum_after_loss(p, muon_plus.mass, loss);
      if (std::isfinite(p) && std::isfinite(loss) && p >= 0.0 && loss > 0.0 && p <= 1e16) CHECK((std::isnan(after.p_new) || after.p_new <= p));
      if (std::isnan(p) || std::isnan(loss) || loss == infinity) CHECK(std::isnan(after.p_new));
      CHECK_FALSE(after.p_new < 0.0);
    }
}

TEST_CASE("a prediction through field and matter from any numbers is sound, or its status says why not", "[extreme]") {
  SECTION("mean loss") { never_lies(mean_energy_loss{}, landau_straggling{}); }
  SECTION("median loss") { never_lies(median_energy_loss{}, bohr_straggling{}); }
  SECTION("no loss") { never_lies(no_energy_loss{}, no_straggling{}); }
}

TEST_CASE("helices of no length, no field and no curvature are where they should be", "[extreme]") {
  using s = slope_state;
  vector<double, 5> start;
  start << 10.0, 0.1, -20.0, 0.2, 0.005;
  const auto still = helix_propagator{three_tesla}.propagate(start, 0.0);
  CHECK(still.state == start);
  for (const double field : {0.0, -0.0, 1e-300}) {
    const auto straight = helix_propagator{field}.propagate(start, 100.0).state;
    CHECK(straight[s::x] == Approx(20.0).epsilon(1e-15));
    CHECK(straight[s::y] == Approx(0.0).margin(1e-14));
    CHECK(straight[s::tx] == Approx(0.1).epsilon(1e-15));
  }
  start[s::q_over_pz] = 1e-300;
  CHECK(helix_propagator{three_tesla}.propagate(start, 100.0).state[s::x] == Approx(20.0).epsilon(1e-15));
}

TEST_CASE("a flight through a field ends, arrived with finite numbers or with the reason why it did not", "[extreme]") {
  const vector<double, 5> usual = (vector<double, 5>() << 10.0, 0.1, -20.0, 0.2, 0.005).finished();
  const auto judge = [](const auto& flight) {
    if (flight.status == flight_status::arrived) CHECK(all_finite(flight.moved.state));
    else CHECK_FALSE(all_finite(flight.moved.state));
  };
  constexpr int most = 64;
  for (const double x : extremes) {
    INFO(x);
    for (int i = 0; i < 5; ++i) {
      vector<double, 5> start = usual;
      start[i] = x;
      judge(nystrom_propagator{graded_field{three_tesla, 1e-4}, nystrom_options{1e-3, 50.0, most}}.fly(start, stretch{0.0, 300.0}));
    }
    judge(nystrom_propagator{graded_field{three_tesla, 1e-4}, nystrom_options{1e-3, 50.0, most}}.fly(usual, stretch{0.0, x}));
    judge(nystrom_propagator{graded_field{three_tesla, 1e-4}, nystrom_options{1e-3, 50.0, most}}.fly(usual, stretch{x, 300.0}));
    judge(nystrom_propagator{graded_field{x, 1e-4}, nystrom_options{1e-3, 50.0, most}}.fly(usual, stretch{0.0, 300.0}));
    judge(nystrom_propagator{graded_field{three_tesla, x}, nystrom_options{1e-3, 50.0, most}}.fly(usual, stretch{0.0, 300.0}));
    judge(nystrom_propagator{graded_field{three_tesla, 1e-4}, nystrom_options{x, 50.0, most}}.fly(usual, stretch{0.0, 300.0}));
    judge(nystrom_propagator{graded_field{three_tesla, 1e-4}, nystrom_options{1e-3, x, most}}.fly(usual, stretch{0.0, 300.0}));
  }
  for (const int steps : {-2147483647, -1, 0, 1}) judge(nystrom_propagator{graded_field{three_tesla, 1e-4}, nystrom_options{1e-3, 50.0, steps}}.fly(usual, stretch{0.0, 300.0}));
}

TEST_CASE("a field map has no field where the place is not a number, whatever it says of places outside", "[extreme]") {
  const grid_axis r{0.0, 50.0, 4}, z{-100.0, 50.0, 5};
  const std::vector<std::array<double, 2>> values(20, {0.0, three_tesla});
  for (const outside_map outside : {outside_map::zero, outside_map::nearest, outside_map::error}) {
    const cylindrical_map<> map(r, z, values, outside);
    for (const double x : extremes)
      for (int i = 0; i < 3; ++i) {
        INFO("coordinate " << i << " is " << x);
        vector<double, 3> at(1.0, 2.0, 3.0);
        at[i] = x;
        const vector<double, 3> b = map(at);
        if (std::isnan(x)) CHECK(std::isnan(b.z()));
        else if (std::abs(x) <= 1.0) CHECK(b.z() == Approx(three_tesla));
        else if (outside == outside_map::zero) CHECK(b.isZero(0.0));
        else if (outside == outside_map::nearest) CHECK((b.z() == Approx(three_tesla) || std::isinf(x)));
        else CHECK(std::isnan(b.z()));
      }
  }
}
