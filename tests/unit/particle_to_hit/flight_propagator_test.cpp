// SPDX-License-Identifier: MPL-2.0
#include <scifi/particle_to_hit/flight_propagator.hpp>

#include <cmath>
#include <cstdint>
#include <limits>

#include <scifi/core/units.hpp>
#include <scifi/field/graded_field.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/particle_to_hit/transport.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/nystrom_propagator.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

using straight = gaussian_scattering<no_scattering>;
using lossless = fixed_loss<no_energy_loss>;

moving_particle muon(const particle& hypothesis, const vector<double, 3>& position, const vector<double, 3>& momentum) { return {hypothesis, position, momentum, 1.0}; }

vector<double, 3> cross(const vector<double, 3>& a, const vector<double, 3>& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()};
}

/// A user's own: Bz = field + gradient z with the Bx, By = -gradient x/2, -gradient y/2 that div B = 0 asks for; Runge-Kutta of fourth order in z.
struct graded_flight {
  double field, gradient;
  using seven = vector<double, 7>;  // position, momentum, time

  [[nodiscard]] seven slope_of(const seven& v, const particle& what) const {
    const vector<double, 3> p = v.segment<3>(3);
    const vector<double, 3> b{-0.5 * gradient * v[0], -0.5 * gradient * v[1], field + gradient * v[2]};
    seven d;
    d << p / p.z(), what.charge * cross(p, b) / p.z(), std::hypot(p.norm(), what.mass) / (p.z() * constants::speed_of_light);
    return d;
  }
  [[nodiscard]] moving_particle propagate(moving_particle m, double dz) const {
    seven v;
    v << m.position, m.momentum, m.t;
    const int steps = 1 + static_cast<int>(std::abs(dz) / 2.0);
    const double h = dz / steps;
    for (int i = 0; i < steps; ++i) {
      const seven a = slope_of(v, m.hypothesis);
      const seven b = slope_of(v + 0.5 * h * a, m.hypothesis);
      const seven c = slope_of(v + 0.5 * h * b, m.hypothesis);
      const seven d = slope_of(v + h * c, m.hypothesis);
      v += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    }
    m.position = v.head<3>();
    m.momentum = v.segment<3>(3);
    m.t = v[6];
    return m;
  }
};

/// What an axially symmetric field conserves besides |p|: x py - y px + q Bz r^2/2, with Bz on the axis there.
double angular_momentum(const vector<double, 3>& r, const vector<double, 3>& p, double bz) {
  return r.x() * p.y() - r.y() * p.x() + 0.5 * bz * (r.x() * r.x() + r.y() * r.y());
}

/// Flies nowhere beyond z = 300 mm.
struct ends_at_300 {
  [[nodiscard]] moving_particle propagate(moving_particle m, double dz) const {
    helix_step(m, m.position.z() + dz > 300.0 ? std::numeric_limits<double>::quiet_NaN() : dz, 0.0);
    return m;
  }
};

static_assert(flight_propagator<helix_flight>);
static_assert(flight_propagator<slope_flight<helix_propagator>>);
static_assert(flight_propagator<graded_flight>);
static_assert(!flight_propagator<helix_propagator>);

}  // namespace

TEST_CASE("a propagator of the fit flies a simulated particle as the helix does, with its time, for every sign of charge, field and flight", "[particle_to_hit]") {
  for (const particle& hypothesis : {muon_plus, muon_minus})
    for (const double field : {3.0 * units::tesla, -2.0 * units::tesla, 0.0})
      for (const double pz : {150.0, -150.0})
        for (const double dz : {400.0, -250.0}) {
          const moving_particle m = muon(hypothesis, {20.0, -30.0, 100.0}, {40.0, -25.0, pz});
          const moving_particle a = helix_flight{field}.propagate(m, dz);
          const moving_particle b = slope_flight<helix_propagator>{{field}}.propagate(m, dz);
          CAPTURE(hypothesis.name, field, pz, dz);
          CHECK((a.position - b.position).norm() < 1e-10);  // rounding of 1e2 mm
          CHECK((a.momentum - b.momentum).norm() < 1e-10);
          CHECK(a.t == Approx(b.t).epsilon(1e-13));
        }
}

TEST_CASE("whether a particle stays within a radius is known of a helix, and looked at in the middle and at the end of any other flight", "[particle_to_hit]") {
  const double field = 3.0 * units::tesla;
  // Half a turn about (100, 0) with radius 50 mm: from (100, 50) by (150, 0), furthest out, to (100, -50).
  const double pt = 50.0 * field, pz = 200.0, dz = constants::pi * pz / field;
  const moving_particle m = muon(muon_plus, {100.0, 50.0, 0.0}, {pt, 0.0, pz});
  const helix_flight helix{field};
  const slope_flight<helix_propagator> slopes{{field}};
  const moving_particle end = helix.propagate(m, dz);
  CHECK(end.position.y() == Approx(-50.0));
  CHECK(helix.largest_radius(m, dz) == Approx(150.0));
  for (const double radius : {149.9, 150.1}) {
    CAPTURE(radius);
    CHECK(stays_within(radius, helix, m, end, dz) == (radius > 150.0));
    CHECK(stays_within(radius, slopes, m, end, dz) == (radius > 150.0));
  }
  CHECK_FALSE(stays_within(111.0, slopes, m, end, dz));  // it begins and ends at 111.8 mm
  moving_particle lost = end;
  lost.position.x() = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(stays_within(1e9, helix, m, lost, dz));
  CHECK_FALSE(stays_within(1e9, slopes, m, lost, dz));
}

TEST_CASE("a simulation in a field that grows along z conserves what theory says, through scattering-free trackers of both directions", "[particle_to_hit]") {
  const detector trackers = mice::trackers();
  const graded_flight graded{3.0 * units::tesla, 0.0003 * units::tesla};  // ten per cent in a metre
  for (const int id : {mice::upstream, mice::downstream}) {
    const tracker& t = *trackers.find(id);
    const double start = id == mice::upstream ? 1130.0 : -30.0;
    const moving_particle m = muon(muon_plus, {30.0, -20.0, start}, {25.0, 40.0, 180.0 * t.beam_direction});
    random_stream random(1, 0, 0);
    truth out, uniform;
    const transport_settings settings{graded.field, 160.0, {}};
    REQUIRE(transport(t, settings, straight{}, lossless{}, graded)(m, 1, random, out) == flight_end::crossed);
    REQUIRE(transport(t, settings, straight{}, lossless{})(m, 1, random, uniform) == flight_end::crossed);
    REQUIRE(out.crossings.size() == 15);
    const auto bz = [&](double z) { return graded.field + graded.gradient * z; };
    const double conserved = angular_momentum(m.position, m.momentum, bz(m.position.z()));
    for (const crossing& c : out.crossings) {
      // Runge-Kutta with steps of 2 mm, 0.01 rad: (0.01)^5 / 120 a step, 1e-10 over 600 of them.
      CHECK(c.momentum.norm() == Approx(m.momentum.norm()).epsilon(1e-9));
      CHECK(angular_momentum(c.position, c.momentum, bz(c.position.z())) == Approx(conserved).epsilon(1e-8));
    }
    // And it is another flight than the helix: 5 % of a turn of some 5 rad on a radius of 50 mm.
    CHECK((out.crossings.back().position - uniform.crossings.back().position).norm() > 3.0);
  }
}

TEST_CASE("the Runge-Kutta-Nystrom propagator of the fit flies a simulated particle through a field that changes", "[particle_to_hit]") {
  const graded_flight graded{3.0 * units::tesla, 0.0003 * units::tesla};
  const slope_flight fit{nystrom_propagator{graded_field{graded.field, graded.gradient}, nystrom_options{.tolerance = 1e-6}}};
  static_assert(flight_propagator<decltype(fit)>);
  for (const particle& hypothesis : {muon_plus, muon_minus})
    for (const double pz : {180.0, -180.0}) {
      const moving_particle m = muon(hypothesis, {30.0, -20.0, 500.0}, {25.0, 40.0, pz});
      const double dz = pz > 0.0 ? 350.0 : -350.0;  // the longest gap between stations
      const moving_particle a = graded.propagate(m, dz);
      const moving_particle b = fit.propagate(m, dz);
      CAPTURE(hypothesis.name, pz);
      CHECK((a.position - b.position).norm() < 1e-4);
      CHECK((a.momentum - b.momentum).norm() < 1e-4);
      CHECK(b.momentum.norm() == Approx(m.momentum.norm()).epsilon(1e-13));
      CHECK(std::abs(b.t - a.t) < 1e-3);  // ns, of 1.4: p/pz is taken as linear between the ends
    }
}

TEST_CASE("without field a simulation by straight lines is one by helices", "[particle_to_hit]") {
  const detector trackers = mice::trackers();
  const tracker& t = *trackers.find(mice::downstream);
  const moving_particle m = muon(muon_minus, {10.0, 5.0, -30.0}, {5.0, -8.0, 200.0});
  random_stream random(1, 0, 0);
  truth out;
  REQUIRE(transport(t, {}, straight{}, lossless{}, slope_flight<helix_propagator>{{0.0}})(m, 1, random, out) == flight_end::crossed);
  REQUIRE(out.crossings.size() == 15);
  for (const crossing& c : out.crossings) {
    const double dz = c.position.z() + 30.0;
    CHECK(c.position.x() == Approx(10.0 + dz * 5.0 / 200.0));
    CHECK(c.position.y() == Approx(5.0 - dz * 8.0 / 200.0));
  }
}

TEST_CASE("a particle that its propagator cannot carry on has left", "[particle_to_hit]") {
  const detector trackers = mice::trackers();
  random_stream random(1, 0, 0);
  truth out;
  const moving_particle m = muon(muon_plus, {0.0, 0.0, -30.0}, {0.0, 0.0, 200.0});
  CHECK(transport(*trackers.find(mice::downstream), {}, straight{}, lossless{}, ends_at_300{})(m, 1, random, out) == flight_end::left);
  CHECK(out.crossings.size() == 6);  // of the stations at 0 and 200 mm
}

TEST_CASE("a pion of another propagator decays as often as its proper time says", "[particle_to_hit]") {
  const detector trackers = mice::trackers();
  const tracker& t = *trackers.find(mice::downstream);
  const transport fly(t, {3.0 * units::tesla, 160.0, {}}, straight{}, lossless{}, slope_flight<helix_propagator>{{3.0 * units::tesla}});
  const moving_particle pion = muon(pion_plus, {0.0, 0.0, -30.0}, {20.0, 0.0, 200.0});
  const double length = t.stations.back().in_tracker.origin.z() + 30.0;
  const double expected = -std::expm1(-length * pion.hypothesis.mass / (200.0 * constants::speed_of_light * mean_life(pion.hypothesis)));
  constexpr int n = 4000;
  int decayed = 0;
  truth out;
  for (int i = 0; i < n; ++i) {
    random_stream random(11, static_cast<std::uint64_t>(i), 0);
    out.clear();
    decayed += fly(pion, 1, random, out) == flight_end::decayed;
  }
  // The way goes to the far side of the last plane, 2 mm more: 0.2 % of the share.
  CHECK(std::abs(decayed - n * expected) < 4.0 * std::sqrt(n * expected * (1.0 - expected)) + 0.002 * n * expected);
}
