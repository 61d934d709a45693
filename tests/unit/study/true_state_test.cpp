// SPDX-License-Identifier: MPL-2.0
#include <cmath>
#include <vector>

#include "support/catch.hpp"
#include "support/flown_particle.hpp"

#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/material/highland.hpp>
#include <scifi/study/true_state.hpp>

using namespace scifi;
using namespace scifi::study;
using s = slope_state;

namespace {

constexpr double field = 3.0 * units::tesla;

}  // namespace

TEST_CASE("on a helix without scattering the state between two crossings lies on the helix", "[study]") {
  const detector d = mice::trackers();
  const auto surfaces = surfaces_along(*d.find(1), +1);
  const vector<double, 5> start = test::five(10, -20, 30, 40, 200);
  const auto crossings = test::flown_particle(*d.find(1), 1, start, field);
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const crossing* const behind = i + 1 < crossings.size() ? &crossings[i + 1] : nullptr;
    const double z = surfaces[i].z;
    const true_state t = true_state_at(surfaces[i], crossings[i], behind, 1, z, field);
    const double angle = field * z / 200.0;
    CHECK(t.mean[s::tx] == Approx((30 * std::cos(angle) + 40 * std::sin(angle)) / 200).epsilon(1e-12));
    CHECK(t.mean[s::ty] == Approx((40 * std::cos(angle) - 30 * std::sin(angle)) / 200).epsilon(1e-12));
    CHECK(t.mean[s::x] == Approx(10 + (40 - 200 * t.mean[s::ty]) / field).epsilon(1e-12));
    CHECK(t.mean[s::y] == Approx(-20 - (30 - 200 * t.mean[s::tx]) / field).epsilon(1e-12));
    CHECK(t.mean[s::q_over_pz] == Approx(1.0 / 200.0));
  }
}

TEST_CASE("what the crossings leave open is the variance of a bridge between them", "[study]") {
  const detector d = mice::trackers();
  const surface plane = surfaces_along(*d.find(1), +1)[1];
  const auto crossings = test::flown_particle(*d.find(1), 1, test::five(0, 0, 0, 0, 200), 0.0);
  // Head on: the layer is the whole station. Mylar and half the doublet in front, half the doublet behind.
  const double station = 3 * (0.025 / materials::mylar.radiation_length + (0.27734 + 0.350) / materials::polystyrene.radiation_length);
  const double half = 0.5 * (0.27734 + 0.350) / materials::polystyrene.radiation_length;
  const auto variance = [&](double layer) { return highland_variance(200.0, muon_plus, layer, station); };
  const double before = variance(half + 0.025 / materials::mylar.radiation_length);
  const double after = variance(half);
  const true_state between = true_state_at(plane, crossings[1], &crossings[2], 1, plane.z, 0.0);
  CHECK(between.open[s::tx] == Approx(before * after / (before + after)).epsilon(1e-3));
  CHECK(between.open[s::ty] == Approx(between.open[s::tx]));
  CHECK(between.open[s::x] == 0.0);
  CHECK(between.open[s::q_over_pz] == 0.0);
  const true_state at_end = true_state_at(plane, crossings[1], nullptr, 1, plane.z, 0.0);
  CHECK(at_end.open[s::tx] == Approx(before).epsilon(1e-3));
}

TEST_CASE("of a kink between two crossings each side takes the share of its material", "[study]") {
  const detector d = mice::trackers();
  surface plane = surfaces_along(*d.find(1), +1)[0];
  auto crossings = test::flown_particle(*d.find(1), 1, test::five(0, 0, 0, 0, 200), 0.0);
  crossings[1].momentum.x() = 20.0;  // dx/dz = 0.1
  plane.below = {};
  plane.below.add(whole(materials::polystyrene, 0.1));
  plane.above = {};
  plane.above.add(whole(materials::polystyrene, 0.3));
  for (slab_stack<4>* stack : {&plane.below, &plane.above}) {
    slab one = (*stack)[0];
    one.layer_radiation_lengths = 0.4 / materials::polystyrene.radiation_length;
    *stack = slab_stack<4>().add(one);
  }
  CHECK(true_state_at(plane, crossings[0], &crossings[1], 1, plane.z, 0.0).mean[s::tx] == Approx(0.025));
}
