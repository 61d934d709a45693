// SPDX-License-Identifier: MPL-2.0
#include <scifi/particle_to_hit/transport.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/particle_to_hit/gun.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

using straight = gaussian_scattering<no_scattering>;
using lossless = fixed_loss<no_energy_loss>;
using mean_loss = fixed_loss<mean_energy_loss>;

const detector trackers = mice::trackers();
const transport_settings three_tesla{3.0 * units::tesla, 160.0, {}};

moving_particle muon(double x, double y, double z, double px, double py, double pz) {
  moving_particle m;
  m.position = {x, y, z};
  m.momentum = {px, py, pz};
  return m;
}

}  // namespace

TEST_CASE("without material a particle flies on one circle with all its momentum and crosses every reference surface", "[particle_to_hit]") {
  for (const int id : {mice::upstream, mice::downstream}) {
    const tracker& t = *trackers.find(id);
    const double start = id == mice::upstream ? 1130.0 : -30.0;
    const moving_particle m = muon(30.0, -20.0, start, 25.0, 40.0, 180.0 * t.beam_direction);
    random_stream random(1, 0, 0);
    truth out;
    CHECK(transport(t, three_tesla, straight{}, lossless{})(m, 1, random, out) == flight_end::crossed);
    REQUIRE(out.crossings.size() == 15);
    CHECK(out.hits.empty());

    const double field = three_tesla.field;
    const double radius = std::hypot(25.0, 40.0) / field;
    const vector<double, 2> centre{30.0 + 40.0 / field, -20.0 - 25.0 / field};
    const auto expected = surfaces_along(t, t.beam_direction);
    for (std::size_t i = 0; i < 15; ++i) {
      const crossing& c = out.crossings[i];
      CHECK(c.station == expected[i].station);
      CHECK(c.plane == expected[i].plane);
      CHECK(c.position.z() == Approx(expected[i].z_reference).margin(1e-9));
      CHECK((c.position.head<2>() - centre).norm() == Approx(radius).epsilon(1e-11));
      CHECK(c.momentum.norm() == Approx(m.momentum.norm()).epsilon(1e-12));
      CHECK(c.momentum.z() == m.momentum.z());
      // Angle turned since the start: q B dz / pz.
      moving_particle direct = m;
      helix_step(direct, c.position.z() - start, field);
      CHECK((c.position - direct.position).norm() < 1e-9);
    }
  }
}

TEST_CASE("with the mean loss a particle arrives with what Bethe's formula leaves it", "[particle_to_hit]") {
  const tracker& t = *trackers.find(mice::downstream);
  random_stream random(2, 0, 0);
  truth out;
  transport(t, three_tesla, straight{}, mean_loss{})(muon(0.0, 0.0, -30.0, 60.0, 0.0, 200.0), 1, random, out);
  REQUIRE(out.crossings.size() == 15);
  // Within a station: one plane of mylar and polystyrene between crossings 0-1 and 1-2.
  for (const std::size_t i : {0u, 1u, 3u, 4u, 12u, 13u}) {
    const double p = out.crossings[i].momentum.norm();
    const double p_after = out.crossings[i + 1].momentum.norm();
    const double path_factor = p / out.crossings[i].momentum.z();
    const double mid = 0.5 * (p + p_after);
    const double expected = path_factor * (0.62734 * mean_energy_loss_rate(mid, muon_plus, materials::polystyrene).value +
                                           0.025 * mean_energy_loss_rate(mid, muon_plus, materials::mylar).value);
    const double lost = std::hypot(p, muon_plus.mass) - std::hypot(p_after, muon_plus.mass);
    CHECK(lost == Approx(expected).epsilon(1e-4));  // the rate changes by 1e-3 through a plane; half of it is in `mid`
  }
}

TEST_CASE("hits lie in fibres on the track and account for the cores' share of the loss", "[particle_to_hit]") {
  const tracker& t = *trackers.find(mice::downstream);
  const transport through(t, three_tesla, straight{}, mean_loss{});
  int planes = 0, with_hit = 0;
  double deposited = 0.0, lost = 0.0;
  for (int i = 0; i < 300; ++i) {
    random_stream random(3, static_cast<std::uint64_t>(i), 0);
    truth out;
    flat_beam beam;
    beam.radius = 40.0;
    beam.pt_max = 40.0;
    through(beam.shoot(t, random), 1, random, out);
    REQUIRE(out.crossings.size() == 15);
    for (const crossing& c : out.crossings) {
      ++planes;
      bool found = false;
      double first_time = 0.0;
      for (const hit& h : out.hits) {
        if (h.id.station != c.station || h.id.plane != c.plane) continue;
        found = true;
        REQUIRE(h.t >= first_time);
        first_time = h.t;
        const plane& p = *trackers.find_plane(h.id);
        const station& s = t.stations[static_cast<std::size_t>(c.station - 1)];
        const vector<double, 3> in_plane = p.in_station().parent_to_child(s.in_tracker.parent_to_child(h.position));
        // The entry point lies on the surface of the core it names.
        REQUIRE(h.id.channel == h.fibre / 7);
        REQUIRE(std::hypot(in_plane.x() - fibre_alpha(p, {}, h.fibre), in_plane.z() - row_height({}, h.fibre % 2)) == Approx(0.154).epsilon(1e-6));
        REQUIRE(std::abs(p.channel_at(in_plane.x()) - h.id.channel) < 0.7);
      }
      with_hit += found;
    }
    const auto energy = [](const crossing& c) { return std::hypot(c.momentum.norm(), muon_plus.mass); };
    for (const std::size_t first : {0u, 3u, 6u, 9u, 12u}) lost += energy(out.crossings[first]) - energy(out.crossings[first + 2]);
    for (const hit& h : out.hits)
      if (h.id.plane < 2) deposited += h.edep;
  }
  CHECK(with_hit == planes);  // seen along z the two rows leave no gap: 0.308 mm of core every 0.2135 mm
  const double mylar = 0.025 * mean_energy_loss_rate(190.0, muon_plus, materials::mylar).value / mean_energy_loss_rate(190.0, muon_plus, materials::polystyrene).value;
  const double share = constants::pi / 4.0 * 0.308 * 0.308 / 0.2135 / (0.62734 + mylar);
  // 3000 planes, each with a spread of 0.08 mm about 0.349 mm of core: five standard deviations are 2 per cent.
  CHECK(deposited / lost == Approx(share).epsilon(0.02));
}

TEST_CASE("every plane has its hit in both trackers with scattering and fluctuating losses, and the order follows the flight", "[particle_to_hit]") {
  for (const int id : {mice::upstream, mice::downstream}) {
    const tracker& t = *trackers.find(id);
    random_stream random(4, 0, 0);
    truth out;
    const transport through(t, three_tesla, coulomb_scattering{}, collision_loss{});
    CHECK(through(muon(0.0, 0.0, id == mice::upstream ? 1130.0 : -30.0, 20.0, 0.0, 200.0 * t.beam_direction), 7, random, out) == flight_end::crossed);
    REQUIRE(out.crossings.size() == 15);
    CHECK(out.crossings.front().station == (id == mice::upstream ? 5 : 1));
    CHECK(out.crossings.front().plane == (id == mice::upstream ? 2 : 0));
    CHECK(out.hits.size() >= 15);
    // Knocked-on electrons come after their muon.
    const auto secondary = std::find_if(out.hits.begin(), out.hits.end(), [](const hit& h) { return h.particle != 7; });
    for (auto h = out.hits.begin() + 1; h < secondary; ++h) CHECK(h->t > (h - 1)->t);
    for (auto h = secondary; h != out.hits.end(); ++h) CHECK(h->parent == 7);
  }
}

TEST_CASE("a particle that goes further out than the tracker is dropped, also between two stations", "[particle_to_hit]") {
  const tracker& t = *trackers.find(mice::downstream);
  random_stream random(5, 0, 0);
  truth out;
  // Circle of radius 66.7 mm about (100, 0): furthest out 166.7 mm, between the stations.
  const double field = three_tesla.field;
  const moving_particle m = muon(100.0, 60.0 / field, -30.0, 60.0, 0.0, 200.0);
  CHECK(transport(t, three_tesla, straight{}, lossless{})(m, 1, random, out) == flight_end::left);
  CHECK(out.crossings.size() < 15);
  for (const crossing& c : out.crossings) CHECK(c.position.head<2>().norm() < 160.0);
  transport_settings wide = three_tesla;
  wide.radius = 170.0;
  out.clear();
  CHECK(transport(t, wide, straight{}, lossless{})(m, 1, random, out) == flight_end::crossed);
}

TEST_CASE("a slow particle stops in the material and leaves all of its energy there", "[particle_to_hit]") {
  const tracker& t = *trackers.find(mice::downstream);
  moving_particle m = muon(0.0, 0.0, -30.0, 0.0, 0.0, 70.0);
  m.hypothesis = proton;  // 2.6 MeV: a range of 0.1 mm
  random_stream random(6, 0, 0);
  truth out;
  CHECK(transport(t, three_tesla, straight{}, mean_loss{})(m, 1, random, out) == flight_end::stopped);
  double deposited = 0.0;
  for (const hit& h : out.hits) deposited += h.edep;
  CHECK(deposited <= m.kinetic_energy());
  CHECK(out.crossings.size() < 15);
}

TEST_CASE("a particle that is inside starts with the planes ahead of it, and one without pz is refused", "[particle_to_hit]") {
  const tracker& t = *trackers.find(mice::downstream);
  random_stream random(7, 0, 0);
  truth out;
  transport(t, three_tesla, straight{}, lossless{})(muon(0.0, 0.0, 500.0, 0.0, 0.0, 200.0), 1, random, out);
  CHECK(out.crossings.size() == 6);
  out.clear();
  transport(t, three_tesla, straight{}, lossless{})(muon(0.0, 0.0, 500.0, 0.0, 0.0, -200.0), 1, random, out);
  CHECK(out.crossings.size() == 9);
  out.clear();
  CHECK(transport(t, three_tesla, straight{}, lossless{})(muon(0.0, 0.0, 500.0, 10.0, 0.0, 0.0), 1, random, out) == flight_end::turned_back);
  CHECK(out.crossings.empty());
}

TEST_CASE("the same stream gives the same event", "[particle_to_hit]") {
  const tracker& t = *trackers.find(mice::downstream);
  const transport through(t, three_tesla, coulomb_scattering{}, collision_loss{});
  truth first, second;
  random_stream one(8, 3, 1, 2), two(8, 3, 1, 2);
  through(muon(5.0, 5.0, -30.0, 20.0, 10.0, 180.0), 1, one, first);
  through(muon(5.0, 5.0, -30.0, 20.0, 10.0, 180.0), 1, two, second);
  REQUIRE(first.hits.size() == second.hits.size());
  for (std::size_t i = 0; i < first.hits.size(); ++i) {
    CHECK(first.hits[i].edep == second.hits[i].edep);
    CHECK(first.hits[i].position == second.hits[i].position);
  }
}

TEST_CASE("muons and pions decay in flight as often as their life says, and their charged daughters are followed", "[particle_to_hit]") {
  const tracker& t = *trackers.find(mice::downstream);
  const transport through(t, three_tesla, straight{}, lossless{});
  transport_settings forever = three_tesla;
  forever.decays = false;
  const transport stable(t, forever, straight{}, lossless{});
  constexpr int n = 4000;
  int decayed = 0, with_muon_hits = 0;
  for (int i = 0; i < n; ++i) {
    moving_particle m = muon(0.0, 0.0, -30.0, 0.0, 0.0, 200.0);
    m.hypothesis = pion_plus;
    random_stream random(11, static_cast<std::uint64_t>(i), 0), other(11, static_cast<std::uint64_t>(i), 0);
    truth out;
    out.last_particle = 1;
    const flight_end end = through(m, 1, random, out);
    REQUIRE(out.particles.front().origin == particle_origin::beam);
    if (end == flight_end::decayed) {
      ++decayed;
      REQUIRE(out.particles.size() >= 2);
      const simulated_particle& child = out.particles[1];
      REQUIRE(child.particle == 2);
      REQUIRE(child.parent == 1);
      REQUIRE(child.pdg_id == muon_plus.pdg_id);
      REQUIRE(child.origin == particle_origin::decay);
      // Energy of the muon between those of one sent backward and forward.
      const double gamma = m.energy() / pion_plus.mass, beta_gamma = 200.0 / pion_plus.mass;
      const double energy = std::hypot(child.momentum.norm(), muon_plus.mass);
      REQUIRE(energy <= gamma * std::hypot(29.79, muon_plus.mass) + beta_gamma * 29.79 + 0.02);
      REQUIRE(energy >= gamma * std::hypot(29.79, muon_plus.mass) - beta_gamma * 29.79 - 0.02);
      REQUIRE(child.t > 0.0);
    }
    for (const crossing& c : out.crossings) REQUIRE(c.pdg_id == pion_plus.pdg_id);
    truth kept;
    REQUIRE(stable(m, 1, other, kept) == flight_end::crossed);
    with_muon_hits += !out.crossings.empty() && out.crossings.size() < 15;
  }
  // From the start to the far side of the last plane, at c tau beta gamma = 7.8045 m * 200/139.57.
  const double expected = 1.0 - std::exp(-(30.0 + 1099.9026 + 1.9570) / (7804.5 * 200.0 / 139.57039));
  CHECK(std::abs(decayed - n * expected) < 5.0 * std::sqrt(n * expected));
  CHECK(with_muon_hits > 0);
}

TEST_CASE("knocked-on electrons have the particle that made them as parent and take their energy along", "[particle_to_hit]") {
  const tracker& t = *trackers.find(mice::downstream);
  transport_settings local = three_tesla;
  local.follow_electrons_from = std::numeric_limits<double>::infinity();
  double followed_sum = 0.0, local_sum = 0.0;
  int electrons = 0;
  constexpr int n = 300;
  for (int i = 0; i < n; ++i) {
    const moving_particle m = muon(5.0, 5.0, -30.0, 20.0, 10.0, 180.0);
    random_stream one(12, static_cast<std::uint64_t>(i), 0), two(12, static_cast<std::uint64_t>(i), 0);
    truth with, without;
    with.last_particle = without.last_particle = 3;
    transport(t, three_tesla, coulomb_scattering{}, collision_loss{})(m, 3, one, with);
    transport(t, local, coulomb_scattering{}, collision_loss{})(m, 3, two, without);
    for (const hit& h : without.hits) CHECK(h.particle == 3);
    for (const hit& h : without.hits) local_sum += h.edep;
    for (const hit& h : with.hits) {
      followed_sum += h.edep;
      REQUIRE((h.particle == 3) == (h.parent == 0));
      REQUIRE(h.pdg_id == (h.particle == 3 ? muon_plus.pdg_id : electron.pdg_id));
    }
    for (std::size_t k = 1; k < with.particles.size(); ++k) {
      REQUIRE(with.particles[k].particle == 3 + static_cast<int>(k));
      REQUIRE(with.particles[k].parent == 3);
      electrons += with.particles[k].origin == particle_origin::knocked_on;
    }
  }
  // Some leave for the gas and the mylar, some come from there: about a few per cent less stay in the cores.
  CHECK(followed_sum < local_sum);
  CHECK(followed_sum > 0.8 * local_sum);
  // xi = 7 keV a plane: 0.15 of them above 45 keV, two a track.
  CHECK(electrons > n);
  CHECK(electrons < 4 * n);
}

TEST_CASE("a positive muon that stops decays at rest into a positron", "[particle_to_hit]") {
  const tracker& t = *trackers.find(mice::downstream);
  random_stream random(13, 0, 0);
  truth out;
  CHECK(transport(t, three_tesla, straight{}, mean_loss{})(muon(0.0, 0.0, -30.0, 0.0, 0.0, 15.0), 1, random, out) == flight_end::stopped);
  REQUIRE(out.particles.size() == 2);
  CHECK(out.particles[1].pdg_id == positron.pdg_id);
  CHECK(out.particles[1].momentum.norm() < 52.83);
}
