// SPDX-License-Identifier: MPL-2.0
#include <scifi/chain/reconstruction.hpp>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <thread>
#include <vector>

#include <scifi/geometry/mice.hpp>
#include <scifi/hit_to_digit/digitiser.hpp>
#include <scifi/particle_to_hit/gun.hpp>
#include <scifi/particle_to_hit/transport.hpp>

#include "support/catch.hpp"
#include "support/ideal_clusters.hpp"

using namespace scifi;

namespace {

const detector where = mice::trackers();
constexpr double three_tesla = 3.0 * units::tesla;

reconstruction_options in_field(double field) {
  reconstruction_options o;
  o.field = field;
  return o;
}

/// An event with this many muons in each tracker.
event simulated(std::uint64_t number, int particles, double field) {
  event e;
  e.number = static_cast<long>(number);
  for (const tracker& t : where.trackers) {
    transport_settings settings;
    settings.field = field;
    const transport fly(t, settings, coulomb_scattering{}, collision_loss{});
    flat_beam beam;
    beam.pt_max = 50.0;
    beam.radius = 60.0;
    truth real;
    real.last_particle = particles;
    random_stream random(77, number, static_cast<std::uint32_t>(t.id));
    for (int i = 1; i <= particles; ++i) fly(beam.shoot(t, random), i, random, real);
    std::vector<raw_digit> digits;
    digitiser<>{}(t, real.hits, random, digits);
    for (const raw_digit& d : digits) e.digits.push_back(d.seen());
  }
  return e;
}

void check_same(const event& a, const event& b) {
  REQUIRE(a.digits.size() == b.digits.size());
  REQUIRE(a.clusters.size() == b.clusters.size());
  REQUIRE(a.space_points.size() == b.space_points.size());
  REQUIRE(a.candidates.size() == b.candidates.size());
  REQUIRE(a.tracks.size() == b.tracks.size());
  REQUIRE(a.track_points.size() == b.track_points.size());
  CHECK(a.flags == b.flags);
  for (std::size_t i = 0; i < a.clusters.size(); ++i) CHECK((a.clusters[i].alpha == b.clusters[i].alpha && a.clusters[i].first_digit == b.clusters[i].first_digit));
  for (std::size_t i = 0; i < a.space_points.size(); ++i) CHECK(a.space_points[i].position == b.space_points[i].position);
  for (std::size_t i = 0; i < a.candidates.size(); ++i) CHECK(a.candidates[i].seed.mean == b.candidates[i].seed.mean);
  for (std::size_t i = 0; i < a.tracks.size(); ++i) {
    CHECK(a.tracks[i].reference.mean == b.tracks[i].reference.mean);
    CHECK(a.tracks[i].reference.covariance == b.tracks[i].reference.covariance);
    CHECK(a.tracks[i].first_point == b.tracks[i].first_point);
  }
  for (std::size_t i = 0; i < a.track_points.size(); ++i) CHECK(a.track_points[i].smoothed.mean == b.track_points[i].smoothed.mean);
}

template <class Chain>
double seconds(const Chain& chain, event& e) {
  const auto start = std::chrono::steady_clock::now();
  chain(e);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

template <class T>
const T& at(const std::vector<T>& v, int i) {
  return v.at(static_cast<std::size_t>(i));
}

}  // namespace

TEST_CASE("from a track everything leads back to its digits", "[chain]") {
  const auto chain = make_reconstruction(where, in_field(three_tesla));
  int tracks = 0;
  for (std::uint64_t number = 0; number < 20; ++number) {
    event e = simulated(number, 2, three_tesla);
    chain(e);
    for (const track& t : e.tracks) {
      ++tracks;
      const candidate& c = at(e.candidates, t.candidate);
      CHECK(c.tracker == t.tracker);
      int clusters = 0;
      for (const int p : c.space_points) {
        const space_point& point = at(e.space_points, p);
        CHECK(point.tracker == t.tracker);
        clusters += static_cast<int>(point.clusters.size());
        for (const int k : point.clusters) {
          const cluster& from = at(e.clusters, k);
          CHECK((from.tracker == t.tracker && from.station == point.station));
          for (int d = from.first_digit; d < from.first_digit + from.size; ++d) {
            const channel_id& id = at(e.digits, d).id;
            CHECK((id.tracker == from.tracker && id.station == from.station && id.plane == from.plane));
          }
        }
      }
      CHECK(t.planes == clusters);
      CHECK(t.stations == static_cast<int>(c.space_points.size()));
      CHECK(t.points == 15);
      int measured = 0;
      for (int k = t.first_point; k < t.first_point + t.points; ++k) measured += at(e.track_points, k).cluster >= 0;
      CHECK(measured == clusters);
    }
  }
  CHECK(tracks > 60);
}

TEST_CASE("memory handed in again changes nothing, and what was reconstructed before is replaced", "[chain]") {
  const auto chain = make_reconstruction(where, in_field(three_tesla));
  decltype(chain)::buffers work;
  event again;
  for (std::uint64_t number = 0; number < 10; ++number) {
    event fresh = simulated(number, 1 + static_cast<int>(number % 3), three_tesla);
    again.clear();
    again.digits = fresh.digits;
    chain(fresh);
    chain(again, work);
    check_same(fresh, again);
    chain(again, work);
    check_same(fresh, again);
  }
}

TEST_CASE("the order of the digits does not matter", "[chain]") {
  const auto chain = make_reconstruction(where, in_field(three_tesla));
  event sorted = simulated(3, 2, three_tesla);
  event shuffled = sorted;
  random_stream random(1, 0, 0);
  for (std::size_t i = shuffled.digits.size(); i > 1; --i)
    std::swap(shuffled.digits[i - 1], shuffled.digits[static_cast<std::size_t>(random.uniform() * static_cast<double>(i))]);
  chain(sorted);
  chain(shuffled);
  check_same(sorted, shuffled);
}

TEST_CASE("nothing comes of an event without digits", "[chain]") {
  const auto chain = make_reconstruction(where, in_field(three_tesla));
  event e;
  e.tracks.resize(2);
  e.flags.fit_failed = true;
  chain(e);
  CHECK(e.clusters.empty());
  CHECK(e.space_points.empty());
  CHECK(e.candidates.empty());
  CHECK(e.tracks.empty());
  CHECK(e.track_points.empty());
  CHECK(e.flags == event_flags{});
}

TEST_CASE("the chain is const and shared: two threads find what one finds", "[chain]") {
  const auto chain = make_reconstruction(where, in_field(three_tesla));
  constexpr std::size_t events = 30;
  std::vector<event> alone, shared;
  for (std::uint64_t i = 0; i < events; ++i) alone.push_back(simulated(i, 2, three_tesla));
  shared = alone;
  for (event& e : alone) chain(e);
  const auto half = [&chain, &shared](std::size_t first) {
    decltype(chain)::buffers work;
    for (std::size_t i = first; i < events; i += 2) chain(shared[i], work);
  };
  std::thread even(half, 0), odd(half, 1);
  even.join();
  odd.join();
  for (std::size_t i = 0; i < events; ++i) check_same(alone[i], shared[i]);
}

TEST_CASE("an event with every channel lit ends soon and says that it was cut short", "[chain]") {
  for (const double field : {three_tesla, 0.0}) {
    INFO("field " << field);
    const auto chain = make_reconstruction(where, in_field(field));
    event e;
    for (const tracker& t : where.trackers)
      for (const station& s : t.stations)
        for (std::size_t p = 0; p < s.planes.size(); ++p)
          for (int channel = 0; channel < s.planes[p].channels; ++channel) e.digits.push_back({{t.id, s.id, static_cast<int>(p), channel}, 10.0});
    // It takes half a second; on a slow and busy machine with sanitizers more.
    CHECK(seconds(chain, e) < 60.0);
    CHECK(e.flags != event_flags{});
  }
}

TEST_CASE("an event with a third of the channels lit ends soon", "[chain]") {
  random_stream random(4, 0, 0);
  const auto chain = make_reconstruction(where, in_field(three_tesla));
  event e;
  for (const station& s : where.trackers[1].stations)
    for (std::size_t p = 0; p < s.planes.size(); ++p)
      for (int channel = 0; channel < s.planes[p].channels; ++channel)
        if (random.uniform() < 0.33) e.digits.push_back({{1, s.id, static_cast<int>(p), channel}, random.uniform(2.0, 20.0)});
  CHECK(seconds(chain, e) < 60.0);
  CHECK(e.flags != event_flags{});
}

TEST_CASE("without a field the momentum given is assumed, with the sign of the hypothesis", "[chain]") {
  reconstruction_options o;
  o.line_momentum = 150.0;
  for (const particle& hypothesis : {muon_plus, muon_minus}) {
    o.hypothesis = hypothesis;
    const auto chain = make_reconstruction(where, o);
    event e = simulated(12, 1, 0.0);
    chain(e);
    REQUIRE_FALSE(e.tracks.empty());
    for (const track& t : e.tracks) {
      CHECK(t.shape == track_shape::line);
      CHECK(t.charge == hypothesis.charge);
      CHECK(t.reference.mean[momentum_state::pz] == Approx(150.0 * where.find(t.tracker)->beam_direction).epsilon(0.02));
    }
  }
}

TEST_CASE("digits below the threshold are not used", "[chain]") {
  reconstruction_options o = in_field(three_tesla);
  o.min_npe = 1e6;
  event e = simulated(1, 1, three_tesla);
  make_reconstruction(where, o)(e);
  CHECK_FALSE(e.digits.empty());
  CHECK(e.clusters.empty());
  CHECK(e.tracks.empty());
}

TEST_CASE("a track that left before it reached the first station is a candidate and no track", "[chain]") {
  // Upstream the beam comes from station 5: straight outwards, beyond the active radius before station 1.
  const tracker& t = where.trackers[mice::upstream];
  vector<double, 5> start;
  start << 240.0, -0.2, 0.0, 0.0, -0.005;
  std::vector<cluster> clusters;
  test::add_ideal_track(t, start, 0.0, clusters);
  event e;
  for (const cluster& c : clusters) {
    const double x = start[0] + start[1] * t.stations[static_cast<std::size_t>(c.station - 1)].in_tracker.origin.z();
    if (std::abs(x) < t.active_radius) e.digits.push_back({{c.tracker, c.station, c.plane, static_cast<int>(std::lround(c.channel))}, 10.0});
  }
  REQUIRE(e.digits.size() == 9);
  make_reconstruction(where, in_field(0.0))(e);
  CHECK(e.candidates.size() == 1);
  CHECK(e.tracks.empty());
  CHECK(e.track_points.empty());
}

TEST_CASE("the stages that the chain shows, called one after the other, make what it makes", "[chain]") {
  const auto chain = make_reconstruction(where, in_field(three_tesla));
  event whole = simulated(5, 3, three_tesla);
  event parts = whole;
  chain(whole);
  REQUIRE(whole.tracks.size() >= 4);
  decltype(chain)::buffers work;
  CHECK(chain.clusters()(chain.where(), parts.digits, parts.clusters));
  for (const auto& s : chain.trackers()) {
    CHECK(chain.space_points()(s.where, parts.clusters, parts.space_points, work.space_points));
    CHECK(s.find_candidates(parts.space_points, parts.clusters.size(), parts.candidates, work.candidates));
  }
  REQUIRE(parts.clusters.size() == whole.clusters.size());
  for (std::size_t i = 0; i < parts.clusters.size(); ++i) CHECK(parts.clusters[i].alpha == whole.clusters[i].alpha);
  REQUIRE(parts.space_points.size() == whole.space_points.size());
  for (std::size_t i = 0; i < parts.space_points.size(); ++i) CHECK(parts.space_points[i].position == whole.space_points[i].position);
  REQUIRE(parts.candidates.size() == whole.candidates.size());
  for (std::size_t i = 0; i < parts.candidates.size(); ++i) CHECK(parts.candidates[i].seed.mean == whole.candidates[i].seed.mean);
  // And they are as the options have them.
  reconstruction_options bright = in_field(three_tesla);
  bright.min_npe = 4.5;
  const auto other = make_reconstruction(where, bright);
  CHECK(other.clusters().min_npe == 4.5);
  CHECK(other.space_points().use == cluster_use::shared);
}

TEST_CASE("every stage can be replaced", "[chain]") {
  struct one_cluster {
    bool operator()(const detector&, std::vector<digit>&, std::vector<cluster>& out) const {
      out.push_back({});
      return false;
    }
  };
  struct one_point {
    struct buffers {};
    bool operator()(const tracker& t, std::span<const cluster> clusters, std::vector<space_point>& out, buffers&) const {
      CHECK(clusters.size() == 1);
      out.push_back({});
      return t.id == 0;
    }
  };
  struct one_candidate {
    struct buffers {};
    bool operator()(std::span<const space_point>, std::size_t clusters, std::vector<candidate>& out, buffers&) const {
      CHECK(clusters == 1);
      candidate c;
      c.seed.mean.setZero();
      c.seed.covariance.setZero();
      out.push_back(c);
      return true;
    }
  };
  struct one_track {
    struct buffers {};
    void operator()(const candidate&, int number, std::span<const space_point>, std::span<const cluster>, std::vector<track>& out, std::vector<track_point>&, buffers&) const {
      track t;
      t.candidate = number;
      t.reference.mean.setZero();
      t.reference.covariance.setIdentity();
      if (number == 1) t.status = {kalman::step_kind::update, kalman::reason::not_finite};
      out.push_back(t);
    }
  };
  using stages = tracker_stages<one_candidate, one_track>;
  const reconstruction chain(where, one_cluster{}, one_point{}, std::vector<stages>{{where.trackers[0], {}, {}}, {where.trackers[1], {}, {}}});
  event e;
  chain(e);
  CHECK(e.clusters.size() == 1);
  CHECK(e.space_points.size() == 2);
  CHECK(e.tracks.size() == 2);
  // Digits were left out, the points of the second tracker were not complete, its fit failed.
  CHECK(e.flags.digits_left_out);
  CHECK(e.flags.combinations_limited);
  CHECK(e.flags.fit_failed);
}
