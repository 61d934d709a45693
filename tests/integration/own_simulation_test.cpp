// SPDX-License-Identifier: MPL-2.0
// Particles simulated by this library, from the gun to digits, and reconstructed by it: both trackers, both charges, any field.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <scifi/chain/reconstruction.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/hit_to_digit/digitiser.hpp>
#include <scifi/particle_to_hit/gun.hpp>
#include <scifi/particle_to_hit/transport.hpp>

#include "support/catch.hpp"
#include "support/track_score.hpp"
#include "support/track_score_checks.hpp"

using namespace scifi;

namespace {

constexpr test::limits sampled{3.0};  // there are some two hundred checks

struct run {
  int tracker = mice::downstream;
  double field = 3.0 * units::tesla;
  particle species = muon_plus;
  int particles_per_event = 1;
  int events = 1000;
  double smallest_pz = 100.0;
  double largest_pz = 280.0;
  double largest_pt = 90.0;
  double radius = 110.0;
  std::uint64_t seed = 1;
  double noise_rate = 0.015;
  double dead_share = 0.0;
};

enum stage : std::uint32_t { gun, flight, digitisation };

/// Simulates and reconstructs; the hypothesis of the reconstruction has the mass of a muon and, without a field, the right charge.
test::track_score simulate_and_score(const run& r) {
  const detector where = mice::trackers();
  const tracker& t = *where.find(r.tracker);
  flat_beam beam;
  beam.hypothesis = r.species;
  beam.pz_min = r.smallest_pz;
  beam.pz_max = r.largest_pz;
  beam.pt_max = r.largest_pt;
  beam.radius = r.radius;
  transport_settings settings;
  settings.field = r.field;
  const transport fly(t, settings, coulomb_scattering{}, collision_loss{});
  digitiser<> digitise;
  digitise.noise.rate = r.noise_rate;
  digitise.dead = drawn_dead_channels(where, r.dead_share, r.seed);
  reconstruction_options options;
  options.field = r.field;
  options.hypothesis = r.species;
  const auto reconstruct = make_reconstruction(where, options);

  test::track_score out(r.field != 0.0);
  typename decltype(reconstruct)::buffers work;
  truth real;
  std::vector<raw_digit> digits;
  event e;
  for (int i = 0; i < r.events; ++i) {
    const auto number = static_cast<std::uint64_t>(i);
    real.clear();
    real.last_particle = r.particles_per_event;
    for (int k = 1; k <= r.particles_per_event; ++k) {
      const auto index = static_cast<std::uint32_t>(k);
      random_stream for_gun(r.seed, number, stage::gun, index);
      random_stream for_flight(r.seed, number, stage::flight, index);
      fly(beam.shoot(t, for_gun), k, for_flight, real);
    }
    random_stream for_digits(r.seed, number, stage::digitisation);
    digitise(t, real.hits, for_digits, digits);
    e.clear();
    for (const raw_digit& d : digits) e.digits.push_back(d.seen());
    reconstruct(e, work);
    out.add(real.crossings, e);
  }
  return out;
}

void check_tracks(const run& r) {
  const test::track_score s = simulate_and_score(r);
  REQUIRE(s.all.expected > r.events / 3);
  CHECK(s.failed == 0);
  sampled.at_least(s.all, 0.985);
  sampled.ghosts_at_most(s.ghosts, s.events, 0.02);
  sampled.spread_at_most(s.x, 0.345);
  sampled.spread_at_most(s.y, 0.345);
  sampled.unit_spread(s.pull[momentum_state::x]);
  sampled.unit_spread(s.pull[momentum_state::y]);
  sampled.unit_mean(s.chi2_per_ndf);
  if (r.field == 0.0) {
    for (const test::sample& pull : s.slope_pull) sampled.unit_spread(pull);
    CHECK(s.charge_above_5.value() == 1.0);
    return;
  }
  for (const int i : {momentum_state::px, momentum_state::py, momentum_state::pz}) {
    INFO(momentum_state::names[static_cast<std::size_t>(i)]);
    sampled.unit_spread(s.pull[static_cast<std::size_t>(i)]);
  }
  // The less a track turns, the less it says of pt.
  if (std::abs(r.field) >= 3.0 * units::tesla) sampled.spread_at_most(s.pt, 1.03);
  sampled.median_zero(s.pt);
  sampled.at_least(s.charge_above_5, 0.995);
}

}  // namespace

TEST_CASE("simulated muons are found in both trackers, with the right charge, state and errors", "[integration]") {
  SECTION("mu+ downstream, 3 T") { check_tracks({}); }
  SECTION("mu+ upstream, 3 T") { check_tracks({.tracker = mice::upstream}); }
  SECTION("mu- downstream, 3 T") { check_tracks({.species = muon_minus}); }
  SECTION("mu- upstream, 3 T") { check_tracks({.tracker = mice::upstream, .species = muon_minus}); }
}

TEST_CASE("the field may have any strength and direction", "[integration]") {
  SECTION("4 T downstream") { check_tracks({.field = 4.0 * units::tesla, .seed = 2}); }
  SECTION("4 T upstream, mu-") { check_tracks({.tracker = mice::upstream, .field = 4.0 * units::tesla, .species = muon_minus, .seed = 2}); }
  SECTION("2 T downstream") { check_tracks({.field = 2.0 * units::tesla, .largest_pt = 60.0, .seed = 2}); }
  SECTION("reversed downstream") { check_tracks({.field = -3.0 * units::tesla, .seed = 3}); }
  SECTION("reversed upstream, mu-") { check_tracks({.tracker = mice::upstream, .field = -3.0 * units::tesla, .species = muon_minus, .seed = 3}); }
}

// Straight tracks are taken for 200 MeV/c, so they have about that; the beam is narrow, so that none leaves the tracker before station 1, where it
// would be missed.
TEST_CASE("without a field straight tracks are found in both trackers", "[integration]") {
  SECTION("upstream") { check_tracks({.tracker = mice::upstream, .field = 0.0, .smallest_pz = 185.0, .largest_pz = 215.0, .largest_pt = 12.0, .radius = 40.0, .seed = 4}); }
  SECTION("downstream, mu-") { check_tracks({.field = 0.0, .species = muon_minus, .smallest_pz = 185.0, .largest_pz = 215.0, .largest_pt = 12.0, .radius = 40.0, .seed = 4}); }
}

TEST_CASE("three muons at once are found and told apart", "[integration]") {
  const test::track_score s = simulate_and_score({.tracker = mice::upstream, .particles_per_event = 3, .events = 400, .largest_pt = 70.0, .seed = 5});
  REQUIRE(s.all.expected > 800);
  CHECK(s.failed == 0);
  sampled.at_least(s.all, 0.95);
  sampled.ghosts_at_most(s.ghosts, s.all.expected, 0.05);
  sampled.at_least(s.charge_above_5, 0.995);
}

TEST_CASE("with three times the noise, or one channel in fifty dead, efficiency and ghosts stay within one per cent", "[integration]") {
  for (const int tracker : {mice::upstream, mice::downstream})
    for (const double field : {3.0 * units::tesla, 0.0}) {
      run as_it_is{.tracker = tracker, .field = field, .seed = 6};
      if (field == 0.0) as_it_is.largest_pt = 20.0, as_it_is.radius = 40.0;
      run noisy = as_it_is, dead = as_it_is;
      noisy.noise_rate *= 3.0;
      dead.dead_share = 0.02;
      const test::track_score reference = simulate_and_score(as_it_is);
      REQUIRE(reference.all.expected > as_it_is.events / 2);
      for (const run& r : {noisy, dead}) {
        // The same particles on the same ways: what differs is not the sample.
        const test::track_score s = simulate_and_score(r);
        CAPTURE(tracker, field, r.noise_rate, r.dead_share, s.all.value(), reference.all.value(), s.ghosts_per_event(), reference.ghosts_per_event());
        REQUIRE(s.all.expected == reference.all.expected);
        CHECK(std::abs(s.all.value() - reference.all.value()) < 0.01);
        CHECK(std::abs(s.ghosts_per_event() - reference.ghosts_per_event()) < 0.01);
      }
    }
}
