// SPDX-License-Identifier: MPL-2.0
// Displaced stations found with simulated muons, digits to alignment, over many seeds: the errors stated are the errors made.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include <Eigen/Cholesky>

#include <scifi/alignment/tracker_alignment.hpp>
#include <scifi/chain/reconstruction.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/hit_to_digit/digitiser.hpp>
#include <scifi/particle_to_hit/gun.hpp>
#include <scifi/particle_to_hit/transport.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

enum stage : std::uint32_t { gun, flight, digitisation, displacement };

struct sample {
  int tracker = mice::downstream;
  double field = 0.0;
  int events = 300;
  flat_beam beam;
};

/// Stations 2, 3 and 4 shifted by 0.5 mm in x and y and turned by 5 mrad, each to a side that the seed says.
tracker displaced(tracker t, std::uint64_t seed) {
  random_stream random(seed, 0, stage::displacement);
  const auto side = [&random] { return random.uniform() < 0.5 ? -1.0 : 1.0; };
  for (std::size_t i = 1; i <= 3; ++i) {
    placement& p = t.stations[i].in_tracker;
    p.origin.x() += 0.5 * side();
    p.origin.y() += 0.5 * side();
    p.angle += 5.0 * units::mrad * side();
  }
  return t;
}

std::vector<event> simulate(const tracker& t, const sample& s, std::uint64_t seed) {
  transport_settings settings;
  settings.field = s.field;
  const transport fly(t, settings, coulomb_scattering{}, collision_loss{});
  const digitiser<> digitise;
  std::vector<event> out;
  truth real;
  std::vector<raw_digit> digits;
  for (int i = 0; i < s.events; ++i) {
    const auto number = static_cast<std::uint64_t>(i);
    real.clear();
    real.last_particle = 1;
    random_stream for_gun(seed, number, stage::gun, 1), for_flight(seed, number, stage::flight, 1), for_digits(seed, number, stage::digitisation);
    fly(s.beam.shoot(t, for_gun), 1, for_flight, real);
    digitise(t, real.hits, for_digits, digits);
    event e;
    for (const raw_digit& d : digits) e.digits.push_back(d.seen());
    out.push_back(e);
  }
  return out;
}

alignment::tracker_alignment align(const tracker& believed, const sample& s, std::vector<event>& events) {
  alignment::tracker_alignment out(believed, {}, alignment::frame::ends, {});
  for (int i = 0; i < 8 && !out.settled(); ++i) {
    const auto chain = make_reconstruction({{out.where()}}, {.field = s.field, .fibre = {}});
    using fitter = std::remove_cvref_t<decltype(chain.trackers().front().fit_track)>;
    const alignment::track_collector<fitter> collect(out.parameters(), chain.trackers().front().fit_track, out.cuts());
    typename std::remove_cvref_t<decltype(chain)>::buffers work;
    typename alignment::track_collector<fitter>::buffers memory;
    alignment::tracker_sum sum = collect.empty();
    for (event& e : events) {
      chain(e, work);
      collect(e, sum, memory);
    }
    out.step(sum);
    REQUIRE(out.last().status == alignment::failure::none);
  }
  REQUIRE(out.settled());
  return out;
}

void check_over_seeds(const sample& s, int seeds) {
  const tracker believed = mice::trackers().trackers[static_cast<std::size_t>(s.tracker)];
  double squares = 0.0;
  int free = 0, beyond_3 = 0;
  for (int k = 1; k <= seeds; ++k) {
    const auto seed = static_cast<std::uint64_t>(k);
    const tracker real = displaced(believed, seed);
    std::vector<event> events = simulate(real, s, seed);
    const alignment::tracker_alignment found = align(believed, s, events);
    // Errors of the parameters of the stations that are not at the ends, and their covariance.
    std::vector<int> inner;
    Eigen::VectorXd error(9);
    for (int i = 0; i < found.parameters().size(); ++i) {
      const alignment::tracker_parameter& p = found.parameters()[i];
      if (p.station == 1 || p.station == 5) continue;
      const auto at = static_cast<std::size_t>(p.station - 1);
      const placement &truth = real.stations[at].in_tracker, &now = found.where().stations[at].in_tracker;
      const vector<double, 3> shift = now.origin - truth.origin;
      const double difference = p.how == alignment::motion::rotation ? now.angle - truth.angle : p.how == alignment::motion::x ? shift.x() : shift.y();
      error[static_cast<Eigen::Index>(inner.size())] = difference;
      inner.push_back(i);
      beyond_3 += std::abs(difference) > 3.0 * found.last().sigma(i);
    }
    REQUIRE(inner.size() == 9);
    const Eigen::MatrixXd covariance = found.last().covariance(inner, inner);
    squares += error.dot(covariance.llt().solve(error));
    free += 9;
  }
  // Whitened by their covariance the pulls are independent: the mean of their squares is known to sqrt(2/n). Four of those, and 10 % either way for the
  // width of the scattering: Highland's formula is 4 % too wide for the core and too narrow for the tails.
  const double width = std::sqrt(squares / free);
  INFO("width of " << free << " pulls: " << width << ", beyond 3: " << beyond_3);
  CHECK(std::abs(width - 1.0) <= 0.1 + 4.0 / std::sqrt(2.0 * free));
  // 0.27 % of a Gaussian; 1 % of so many is four or more standard errors above.
  CHECK(beyond_3 <= 0.01 * free + 1);
}

}  // namespace

TEST_CASE("displaced stations are found with straight muons, with the errors stated", "[integration]") {
  sample s;
  s.beam.pz_min = 190.0;
  s.beam.pz_max = 210.0;
  s.beam.pt_max = 12.0;
  s.beam.radius = 80.0;
  check_over_seeds(s, 48);
}

TEST_CASE("displaced stations are found with helices, with the errors stated", "[integration]") {
  sample s;
  s.tracker = mice::upstream;
  s.field = 3.0 * units::tesla;
  s.events = 350;
  check_over_seeds(s, 24);
}
