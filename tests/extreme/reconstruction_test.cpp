// SPDX-License-Identifier: MPL-2.0
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include <scifi/chain/reconstruction.hpp>
#include <scifi/event/event.hpp>
#include <scifi/geometry/mice.hpp>

#include "extreme/extremes.hpp"
#include "support/catch.hpp"
#include "support/ideal_clusters.hpp"

using namespace scifi;
using test::all_finite;
using test::extremes;
using test::infinity;
using test::not_a_number;
using test::sound;

namespace {

constexpr double three_tesla = 3.0 * units::tesla;

const detector& trackers() {
  static const detector both = mice::trackers();
  return both;
}
const tracker& downstream() { return *trackers().find(mice::downstream); }

const auto& chain() {
  static const auto built = make_reconstruction(trackers(), {three_tesla, muon_plus});
  return built;
}

/// The clusters of a track of 200 MeV/c, as they come from the planes.
std::vector<cluster> clusters_of_a_track() {
  std::vector<cluster> clusters;
  vector<double, 5> start;
  start << 10.0, 0.15, -20.0, 0.1, 1.0 / 200.0;
  test::add_ideal_track(downstream(), start, three_tesla, clusters);
  test::sort_clusters(clusters);
  return clusters;
}

/// A digit in each channel of those clusters.
event event_of(const std::vector<cluster>& clusters) {
  event e;
  for (const cluster& c : clusters) e.digits.push_back({{c.tracker, c.station, c.plane, static_cast<int>(std::lround(c.channel))}, 10.0});
  return e;
}

/// `exact`: a cluster without an error of its own, of which the other measurements' residual cannot be told apart.
void holds_no_lie(const event& e, int exact = -1) {
  for (const cluster& c : e.clusters) CHECK((std::isfinite(c.alpha) && c.variance > 0.0 && std::isfinite(c.channel) && !std::isnan(c.npe)));
  for (const space_point& p : e.space_points) CHECK((all_finite(p.position) && all_finite(p.covariance) && std::isfinite(p.chi2)));
  for (const candidate& c : e.candidates) CHECK((sound(c.seed) && std::isfinite(c.chi2)));
  for (const track& t : e.tracks) {
    if (!t.status.ok()) continue;
    CHECK((sound(t.reference) && std::isfinite(t.chi2) && t.p_value >= 0.0 && t.p_value <= 1.0));
    for (int i = 0; i < t.points; ++i) {
      const track_point& p = e.track_points[static_cast<std::size_t>(t.first_point + i)];
      CHECK((sound(p.smoothed) && std::isfinite(p.chi2)));
      if (p.cluster < 0 || p.cluster != exact) CHECK(std::isfinite(p.residual) == (p.cluster >= 0));
    }
  }
}

}  // namespace

TEST_CASE("a track whose digits are whole is found, as what the tables below put out of order", "[extreme]") {
  event e = event_of(clusters_of_a_track());
  chain()(e);
  REQUIRE(e.tracks.size() == 1);
  CHECK(e.tracks[0].status.ok());
  holds_no_lie(e);
}

TEST_CASE("digits of any light in any channel make no cluster, point or track that is not finite", "[extreme]") {
  for (const double light : extremes) {
    INFO("light " << light);
    event one = event_of(clusters_of_a_track());
    one.digits[4].npe = light;
    chain()(one);
    holds_no_lie(one);
    event all = event_of(clusters_of_a_track());
    for (digit& d : all.digits) d.npe = light;
    chain()(all);
    holds_no_lie(all);
    if (std::isnan(light)) CHECK(all.clusters.empty());
  }
  constexpr int least = std::numeric_limits<int>::min(), most = std::numeric_limits<int>::max();
  for (const int number : {least, -1, 0, 213, 214, 100000, most - 1, most}) {
    INFO("number " << number);
    for (int slot = 0; slot < 4; ++slot) {
      event e = event_of(clusters_of_a_track());
      channel_id& id = e.digits[4].id;
      (slot == 0 ? id.tracker : slot == 1 ? id.station : slot == 2 ? id.plane : id.channel) = number;
      chain()(e);
      holds_no_lie(e);
    }
  }
}

TEST_CASE("channels that a plane does not have make no cluster, however many of them are lit side by side", "[extreme]") {
  const int channels = downstream().stations[0].planes[0].channels;
  std::vector<digit> digits;
  for (int channel = -300000; channel < 300000; ++channel) digits.push_back({{mice::downstream, 1, 0, channel}, 3.0 + 1e-6 * channel});
  std::vector<cluster> clusters;
  cluster_finder<>{}(trackers(), digits, clusters);
  int lit = 0;
  for (const cluster& c : clusters) {
    CHECK((c.channel >= 0.0 && c.channel <= channels - 1.0));
    lit += c.size;
  }
  CHECK(lit == channels);
}

TEST_CASE("clusters with any numbers make no space point that is not finite", "[extreme]") {
  for (const double x : extremes)
    for (int slot = 0; slot < 4; ++slot) {
      INFO("slot " << slot << " is " << x);
      std::vector<cluster> clusters = clusters_of_a_track();
      const std::array<double*, 4> at{&clusters[1].alpha, &clusters[1].variance, &clusters[1].npe, &clusters[1].channel};
      *at[static_cast<std::size_t>(slot)] = x;
      std::vector<space_point> points;
      space_point_finder::buffers work;
      (void)space_point_finder{}(downstream(), clusters, points, work);
      for (const space_point& p : points) CHECK((all_finite(p.position) && std::isfinite(p.chi2) && std::isfinite(p.z)));
    }
}

TEST_CASE("space points with any numbers make no candidate that is not finite, and a track of any clusters is sound or has a status", "[extreme]") {
  const std::vector<cluster> whole = clusters_of_a_track();
  std::vector<space_point> points;
  space_point_finder::buffers work;
  (void)space_point_finder{}(downstream(), whole, points, work);
  REQUIRE(points.size() == 5);
  track_finder_options options;
  options.field = three_tesla;
  const track_finder find(downstream(), options, muon_plus, highland_scattering{});
  track_fit_options fitting;
  fitting.field = three_tesla;
  const track_fitter fit(downstream(), fitting, muon_plus, mean_energy_loss{}, highland_scattering{}, landau_straggling{5.0});
  track_finder::buffers finding;
  decltype(fit)::buffers fits;

  for (const double x : extremes)
    for (int slot = 0; slot < 6; ++slot) {
      INFO("slot " << slot << " is " << x);
      std::vector<space_point> odd = points;
      const std::array<double*, 6> at{&odd[2].position[0], &odd[2].position[1], &odd[2].z, &odd[2].covariance(0, 0), &odd[2].chi2, &odd[2].npe};
      *at[static_cast<std::size_t>(slot)] = x;
      std::vector<candidate> found;
      (void)find(odd, whole.size(), found, finding);
      for (const candidate& c : found) CHECK(all_finite(c.seed.mean));
    }

  std::vector<candidate> found;
  (void)find(points, whole.size(), found, finding);
  REQUIRE(found.size() == 1);
  for (const double x : extremes)
    for (int slot = 0; slot < 8; ++slot) {
      INFO("slot " << slot << " is " << x);
      std::vector<cluster> odd = whole;
      candidate from = found[0];
      const std::array<double*, 8> at{&odd[7].alpha,     &odd[7].variance,  &from.seed.mean[0], &from.seed.mean[1],
                                      &from.seed.mean[2], &from.seed.mean[3], &from.seed.mean[4], &from.z};
      *at[static_cast<std::size_t>(slot)] = x;
      event out;
      fit(from, 0, points, odd, out.tracks, out.track_points, fits);
      REQUIRE(out.tracks.size() == 1);
      if (!std::isfinite(x)) CHECK_FALSE(out.tracks[0].status.ok());
      holds_no_lie(out, slot == 1 && x < 1e-100 ? 7 : -1);
    }
}

TEST_CASE("a chain with any settings is refused, or finds what is finite", "[extreme]") {
  for (const double x : extremes)
    for (int slot = 0; slot < 3; ++slot) {
      INFO("slot " << slot << " is " << x);
      reconstruction_options options{three_tesla, muon_plus};
      const std::array<double*, 3> at{&options.field, &options.min_npe, &options.line_momentum};
      *at[static_cast<std::size_t>(slot)] = x;
      event e = event_of(clusters_of_a_track());
      try {
        make_reconstruction(trackers(), options)(e);
        CHECK((slot == 1 || std::isfinite(x)));
      } catch (const std::invalid_argument&) {
        CHECK(slot != 1);
      }
      holds_no_lie(e);
    }
}

TEST_CASE("options of a track finder that make no sense are refused", "[extreme]") {
  for (const double x : extremes)
    for (int slot = 0; slot < 6; ++slot) {
      INFO("slot " << slot << " is " << x);
      track_finder_options o;
      const std::array<double*, 6> at{&o.field, &o.line_momentum, &o.largest_slope, &o.smallest_pz, &o.prior.typical, &o.prior.spread};
      *at[static_cast<std::size_t>(slot)] = x;
      if (!std::isfinite(x) || (slot != 0 && x < 0.0)) CHECK_THROWS_AS(o.check(), std::invalid_argument);
    }
  CHECK_NOTHROW(track_finder_options{}.check());
}
