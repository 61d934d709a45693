// SPDX-License-Identifier: MPL-2.0
#include <scifi/particle_to_hit/electron_flight.hpp>

#include <cmath>

#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

const detector trackers = mice::trackers();
const tracker& downstream = *trackers.find(mice::downstream);

transport_settings in_field(double tesla) {
  transport_settings s;
  s.field = tesla * units::tesla;
  return s;
}

moving_particle at(double x, double z, double kinetic_energy, const vector<double, 3>& direction) {
  moving_particle m;
  m.hypothesis = electron;
  m.position = {x, 0.0, z};
  m.momentum = std::sqrt(kinetic_energy * (kinetic_energy + 2.0 * electron.mass)) * direction.normalized();
  return m;
}

double deposited(const truth& t) {
  double sum = 0.0;
  for (const hit& h : t.hits) sum += h.edep;
  return sum;
}

}  // namespace

TEST_CASE("an electron that stops inside one core leaves all of its energy there", "[particle_to_hit]") {
  // In the middle of fibre 742 of plane U of station 1; 50 keV have a range of 0.04 mm, the core a radius of 0.154 mm.
  const fibre_layer layer = fibre_layers(downstream)[2];
  const double z = layer.at.z + row_height({}, 0);
  const electron_flight fly(downstream, in_field(3.0));
  for (int i = 0; i < 50; ++i) {
    random_stream random(1, static_cast<std::uint64_t>(i), 0);
    truth out;
    fly(at(fibre_alpha(layer.of, {}, 742), z, 0.05, {1.0, 0.5, 0.3}), 5, 2, random, out);
    REQUIRE(out.hits.size() == 1);
    CHECK(out.hits[0].id == channel_id{1, 1, 2, 106});
    CHECK(out.hits[0].fibre == 742);
    CHECK(out.hits[0].particle == 5);
    CHECK(out.hits[0].parent == 2);
    CHECK(out.hits[0].pdg_id == 11);
    CHECK(out.hits[0].edep == Approx(0.05).epsilon(1e-3));  // the steps use the loss in the middle of each
  }
}

TEST_CASE("electrons go as deep into plastic as the practical range says", "[particle_to_hit]") {
  // A tracker of one thick block of plastic; the depth that few electrons pass. Katz, Penfold, Rev. Mod. Phys. 24 (1952) 28:
  // R = 412 T^(1.265 - 0.0954 ln T) mg/cm2, good to some 5 % for light elements, 0.01 < T < 2.5 MeV.
  tracker block;
  block.gas = materials::vacuum;
  station s;
  plane p = mice::fibre_plane("U", 0.0, 212, 105.5, 0.0);
  p.below = slab_stack<4>{};
  p.above = slab_stack<4>{};
  p.z_measured = 0.0;
  s.planes = {p};
  for (const double kinetic_energy : {0.2, 1.0}) {
    const double range = 0.412 * std::pow(kinetic_energy, 1.265 - 0.0954 * std::log(kinetic_energy)) / materials::polystyrene.density * units::cm;
    const auto passed = [&](double thickness) {
      tracker t = block;
      s.planes[0].below = slab_stack<4>{}.add(whole(materials::polystyrene, thickness));
      s.planes[0].z_measured = thickness;
      // A second plane behind, so thick that all that arrives stops, with its fibres in front, catches what came through.
      plane behind = mice::fibre_plane("U", 0.0, 212, 105.5, thickness + 1.0);
      behind.above.add(whole(materials::polystyrene, 50.0));
      s.planes.resize(1);
      s.planes.push_back(behind);
      t.stations = {s};
      const electron_flight fly(t, in_field(0.0));
      int count = 0;
      constexpr int n = 400;
      for (int i = 0; i < n; ++i) {
        random_stream random(2, static_cast<std::uint64_t>(i), 0);
        truth out;
        fly(at(0.0, -0.1, kinetic_energy, {0.0, 0.0, 1.0}), 1, 0, random, out);
        bool through = false;
        for (const hit& h : out.hits) through = through || h.id.plane == 1;
        count += through;
      }
      return static_cast<double>(count) / n;
    };
    CAPTURE(kinetic_energy, range);
    CHECK(passed(0.25 * range) > 0.55);
    CHECK(passed(0.7 * range) > 0.01);
    CHECK(passed(1.15 * range) < 0.02);
  }
}

TEST_CASE("a fast electron follows its helix through the gas and lights the planes that it meets, in either direction", "[particle_to_hit]") {
  const electron_flight fly(downstream, in_field(3.0));
  for (const double direction : {1.0, -1.0}) {
    random_stream random(3, 0, 0);
    truth out;
    const double start = direction > 0.0 ? -30.0 : 1130.0;
    fly(at(0.0, start, 50.0, {0.2, 0.0, direction}), 1, 0, random, out);
    CHECK(out.hits.size() >= 15);
    CHECK(out.hits.front().id.station == (direction > 0.0 ? 1 : 5));
    moving_particle helix = at(0.0, start, 50.0, {0.2, 0.0, direction});
    helix_step(helix, out.hits.front().position.z() - start, 3.0 * units::tesla);
    CHECK((helix.position - out.hits.front().position).norm() < 0.1);  // scattering and a step of 0.03 mm
  }
}

TEST_CASE("electrons that circle too often in a gap, or leave the tracker, are dropped", "[particle_to_hit]") {
  transport_settings settings = in_field(3.0);
  const auto reaches_next_station = [&](const moving_particle& m) {
    random_stream random(4, 0, 0);
    truth out;
    electron_flight(downstream, settings)(m, 1, 0, random, out);
    return !out.hits.empty();
  };
  // Pitch 2 pi pz / (q B): 40 turns in the 100 mm before station 2.
  const double pz = 100.0 * settings.field / (2.0 * constants::pi * 40.0);
  moving_particle m = at(0.0, 100.8936, 1.0, {0.0, 0.0, 1.0});
  m.momentum = {1.0, 0.0, pz};
  CHECK_FALSE(reaches_next_station(m));
  settings.most_turns = 60.0;
  CHECK(reaches_next_station(m));
  settings.radius = 160.0;
  m.position.x() = 159.9;
  m.momentum = {1.0, 0.0, 1.0};  // outwards
  CHECK_FALSE(reaches_next_station(m));
}

TEST_CASE("no electron leaves more than it has", "[particle_to_hit]") {
  const electron_flight fly(downstream, in_field(3.0));
  for (int i = 0; i < 200; ++i) {
    random_stream random(5, static_cast<std::uint64_t>(i), 0);
    const double kinetic_energy = random.uniform(0.02, 2.0);
    truth out;
    fly(at(random.uniform(-50.0, 50.0), random.uniform(0.0, 2.0), kinetic_energy, {random.normal(), random.normal(), random.normal()}), 1, 0, random, out);
    CHECK(deposited(out) <= kinetic_energy * (1.0 + 1e-3));
    for (std::size_t a = 0; a < out.hits.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) CHECK_FALSE((out.hits[a].id == out.hits[b].id && out.hits[a].fibre == out.hits[b].fibre));
  }
}
