// SPDX-License-Identifier: MPL-2.0
// Fits in the field of coils that changes by 3 % along a tracker: with the helix of the mean field and with Runge-Kutta-Nystrom steps through a map.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // GCC 12 of the working memory of Boost's integrators, which they fill before they read it
#endif

#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <scifi/candidate_to_track/track_fitter.hpp>
#include <scifi/core/random.hpp>
#include <scifi/field/coil_field.hpp>
#include <scifi/field/tabulate.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/material/straggling.hpp>
#include <scifi/track_model/nystrom_propagator.hpp>

#include "support/catch.hpp"
#include "support/ideal_clusters.hpp"
#include "support/sample.hpp"
#include "unit/track_model/lorentz.hpp"

using namespace scifi;

namespace {

/// A main coil and two thicker ones at its ends, about the middle of a tracker, as in the experiment.
const coil_field coils({{vector<double, 3>(0.0, 0.0, 552.0), vector<double, 3>::UnitZ(), 1314.0, 258.0, 22.0, 125.0},
                        {vector<double, 3>(0.0, 0.0, -200.0), vector<double, 3>::UnitZ(), 110.0, 258.0, 54.8, 125.0},
                        {vector<double, 3>(0.0, 0.0, 1304.0), vector<double, 3>::UnitZ(), 110.0, 258.0, 54.8, 125.0}});

/// Mean on the axis and (largest - smallest) / mean there, over the length of the tracker.
struct along_axis {
  double mean = 0.0, variation = 0.0;
};
along_axis field_along(double length) {
  constexpr int steps = 200;
  test::sample seen;
  for (int i = 0; i < steps; ++i) seen.add(coils(vector<double, 3>(0.0, 0.0, length * (i + 0.5) / steps)).z());
  return {seen.mean(), (seen.quantile(1.0) - seen.quantile(0.0)) / seen.mean()};
}

/// A track that an integrator of another make carries through the coils, its exact crossings smeared by the resolution of a channel.
struct simulated {
  vector<double, 5> truth;  // momentum_state at z = 0
  std::vector<cluster> clusters;
  candidate found;
  std::vector<space_point> points;
};

simulated simulate(const tracker& t, const std::vector<surface>& surfaces, double mean_field, std::uint64_t number) {
  random_stream random(7, number, 0);
  simulated out;
  const double pz = random.uniform(140.0, 260.0), pt = random.uniform(10.0, 60.0), phi = random.uniform(0.0, 2.0 * constants::pi);
  const int charge = number % 2 == 0 ? 1 : -1;
  out.truth << random.uniform(-40.0, 40.0), random.uniform(-40.0, 40.0), pt * std::cos(phi), pt * std::sin(phi), pz;
  test::moving now{{out.truth[0], out.truth[1], 0.0}, {out.truth[2], out.truth[3], pz}, double(charge)};
  for (const surface& s : surfaces) {
    now = test::carried_to(now, s.z, coils);
    cluster c = test::ideal_cluster(t, s, now.position[0], now.position[1]);
    c.alpha += std::sqrt(c.variance) * random.normal();
    if (out.points.empty() || out.points.back().station != s.station) {
      space_point p;
      p.tracker = t.id;
      p.station = s.station;
      out.found.space_points.push_back(static_cast<int>(out.points.size()));
      out.points.push_back(p);
    }
    out.points.back().clusters.push_back(static_cast<int>(out.clusters.size()));
    out.clusters.push_back(c);
  }
  // The seed is that of pattern recognition, good to a few resolutions, in the mean field.
  const vector<double, 5> start = momentum_to_slopes(out.truth, charge).state;
  out.found.tracker = t.id;
  out.found.shape = track_shape::helix;
  out.found.z = surfaces.back().z;
  out.found.seed.mean = helix_propagator{mean_field}.propagate(start, out.found.z).state;
  out.found.seed.mean[slope_state::x] = now.position[0] + random.normal();
  out.found.seed.mean[slope_state::y] = now.position[1] + random.normal();
  out.found.seed.covariance.setIdentity();
  return out;
}

struct scores {
  std::array<test::sample, 5> pull;
  test::sample chi2, residual_pull;

  template <class Fitter>
  void add(const Fitter& fitter, const simulated& s, std::uint64_t number) {
    std::vector<track> tracks;
    std::vector<track_point> points;
    typename Fitter::buffers work;
    fitter(s.found, 0, s.points, s.clusters, tracks, points, work);
    REQUIRE(tracks.size() == 1);
    REQUIRE(tracks[0].status.ok());
    REQUIRE(tracks[0].ndf == 10);
    for (int k = 0; k < 5; ++k) pull[static_cast<std::size_t>(k)].add((tracks[0].reference.mean[k] - s.truth[k]) / kalman::sigma(tracks[0].reference, k));
    chi2.add(tracks[0].chi2);
    residual_pull.add(points[number % points.size()].pull);
  }
};

}  // namespace

TEST_CASE("in a field that changes by 3 % the fit with Runge-Kutta-Nystrom steps has unit pulls, and the helix has not", "[integration]") {
  const detector both = mice::trackers();
  const tracker& t = *both.find(mice::downstream);
  const std::vector<surface> surfaces = surfaces_along(t, +1);
  const along_axis seen = field_along(surfaces.back().z);
  REQUIRE(seen.variation == Approx(0.03).margin(0.001));

  const auto map = tabulated(coils, {0.0, 20.0, 12}, {-100.0, 20.0, 66}, outside_map::error);
  track_fit_options options;
  options.field = seen.mean;
  options.passes = 3;
  const track_fitter through_map(t, options, muon_plus, no_energy_loss{}, no_scattering{}, no_straggling{}, kalman::joseph{}, kalman::no_gate{}, nystrom_propagator{map});
  const track_fitter on_helix(t, options, muon_plus, no_energy_loss{}, no_scattering{}, no_straggling{});
  constexpr std::uint64_t tracks = 1500;
  scores nystrom, helix;
  for (std::uint64_t i = 0; i < tracks; ++i) {
    const simulated s = simulate(t, surfaces, seen.mean, i);
    nystrom.add(through_map, s, i);
    helix.add(on_helix, s, i);
  }
  const auto n = static_cast<double>(tracks);
  double widest = 0.0;
  for (std::size_t k = 0; k < 5; ++k) {
    INFO(momentum_state::names[k] << ": pulls " << nystrom.pull[k].mean() << " +- " << nystrom.pull[k].standard_deviation() << " in steps, " << helix.pull[k].mean() << " +- "
                                  << helix.pull[k].standard_deviation() << " on the helix");
    CHECK(std::abs(nystrom.pull[k].mean()) < 4.0 / std::sqrt(n));
    CHECK(std::abs(nystrom.pull[k].standard_deviation() - 1.0) < 4.0 / std::sqrt(2.0 * n));
    widest = std::max(widest, helix.pull[k].standard_deviation());
  }
  INFO("chi2 of 10: " << nystrom.chi2.mean() << " in steps, " << helix.chi2.mean() << " on the helix; widest pull on the helix " << widest);
  CHECK(std::abs(nystrom.residual_pull.standard_deviation() - 1.0) < 4.0 / std::sqrt(2.0 * n));
  CHECK(std::abs(nystrom.chi2.mean() - 10.0) < 4.0 * std::sqrt(20.0 / n));
  CHECK(widest > 1.5);
  CHECK(std::abs(helix.pull[momentum_state::pz].mean()) > 1.5);
}
