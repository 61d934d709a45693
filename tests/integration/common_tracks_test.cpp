// SPDX-License-Identifier: MPL-2.0
// 20,000 simulated muons with their seeds, which the KalmanFitter of ACTS v47.5 fitted too: the same estimate must come out.
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <scifi/io/csv.hpp>
#include <scifi/kalman/relinearised.hpp>
#include <scifi/track_model/conversions.hpp>
#include <scifi/track_model/energy_loss_propagator.hpp>
#include <scifi/track_model/fibre_measurement.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/material_noise.hpp>

#include "support/catch.hpp"
#include "support/sample.hpp"
#include "support/shared_data.hpp"

using namespace scifi;

namespace {

constexpr std::size_t planes = 15;
constexpr double field = 3.0 * units::tesla;

// The medium of the simulation, with the density effect moved out of reach: its energy loss has none.
constexpr material plastic{"polystyrene", 1.06, 424.5, 0.538, 68.7 * units::eV, {0.0, 3.0, 100.0, 200.0, 0.0, 0.0}};
constexpr slab sheet = whole(plastic, 0.45);

struct site {
  leg step;
  fibre_measurement<slope_state> measurement;
};

struct simulated_track {
  std::array<site, planes> sites;
  vector<double, 5> truth;  // momentum_state at the first plane
  vector<double, 5> seed;
};

std::vector<simulated_track> read_tracks(const std::filesystem::path& folder) {
  constexpr double channel_width = 1.4945;
  std::vector<simulated_track> tracks;
  double z_before = 0.0;
  csv_reader rows(folder / "common_tracks.csv.gz", {"track", "plane", "z", "angle_deg", "alpha", "true_x", "true_y", "true_px", "true_py", "true_pz"});
  while (rows.next_row()) {
    const auto track = rows.whole_number<std::size_t>(0);
    const auto plane = rows.whole_number<std::size_t>(1);
    if (track >= tracks.size()) tracks.resize(track + 1);
    const double angle = rows.number(3) * units::degree;
    leg step;
    if (plane > 0) {
      step.dz = rows.number(2) - z_before;
      step.start.add(sheet);  // truth and measurement of a plane come before its material
    } else {
      tracks[track].truth << rows.number(5), rows.number(6), rows.number(7), rows.number(8), rows.number(9);
    }
    z_before = rows.number(2);
    tracks[track].sites.at(plane) = {step, {rows.number(4), channel_width * channel_width / 12.0, std::cos(angle), std::sin(angle), 0.0}};
  }
  csv_reader seeds(folder / "common_seeds.csv.gz", {"track", "x", "y", "px", "py", "pz"});
  while (seeds.next_row()) tracks.at(seeds.whole_number<std::size_t>(0)).seed << seeds.number(1), seeds.number(2), seeds.number(3), seeds.number(4), seeds.number(5);
  return tracks;
}

/// The seed with a hundred times the covariance with which it was smeared.
kalman::estimate<double, 5> start_of(const simulated_track& t) {
  const vector<double, 5> sigma{1.0, 1.0, 1.5, 1.5, 0.03 * t.seed[momentum_state::pz]};
  const auto momenta = kalman::uncorrelated(t.seed, (10.0 * sigma).eval());
  return convert(momenta, [](const vector<double, 5>& x) { return momentum_to_slopes(x, muon_plus.charge); });
}

struct found {
  std::array<test::sample, 5> residual, pull;
  test::sample chi2;
  int failed = 0;

  void add(const simulated_track& t, const kalman::estimate<double, 5>& first_plane, double chi2_of_track) {
    const auto e = convert(first_plane, [](const vector<double, 5>& x) { return slopes_to_momentum(x, +1); });
    chi2.add(chi2_of_track);
    for (int i = 0; i < 5; ++i) {
      const auto k = static_cast<std::size_t>(i);
      residual[k].add(e.mean[i] - t.truth[i]);
      pull[k].add((e.mean[i] - t.truth[i]) / kalman::sigma(e, i));
    }
  }
};

const kalman::filter fit(energy_loss_propagator{helix_propagator{field}, mean_energy_loss{}, muon_plus, +1},
                         material_noise{highland_scattering{}, no_straggling{}, muon_plus});

}  // namespace

TEST_CASE("the filter and smoother find what ACTS finds on the same tracks", "[integration]") {
  const auto data = test::shared_data();
  if (!data) return;
  const std::vector<simulated_track> tracks = read_tracks(*data / "peers");
  REQUIRE(tracks.size() == 20000);

  // The extended filter as it stands, linearised where the filter is: what ACTS does too.
  found once;
  // Two passes, the second about the smoothed track of the first.
  found twice;
  std::array<kalman::node<double, 5, 1>, planes> nodes;
  std::array<vector<double, 5>, planes + 1> references;
  for (const simulated_track& t : tracks) {
    const auto start = start_of(t);
    const auto result = fit.run(start, t.sites, nodes);
    if (result.status.ok() && kalman::smooth(nodes).ok())
      once.add(t, nodes[0].smoothed, result.chi2);
    else
      ++once.failed;
    const auto again = kalman::run_relinearised(fit, start, start.mean, t.sites, nodes, references, 2);
    if (again.status.ok())
      twice.add(t, nodes[0].smoothed, again.chi2);
    else
      ++twice.failed;
  }
  CHECK(once.failed == 0);
  CHECK(twice.failed == 0);

  constexpr double close = 0.01;
  const std::array<double, 5> acts_deviation{0.3295, 0.3301, 0.8119, 0.8321, 8.245};  // x, y (mm), px, py, pz (MeV/c)
  const std::array<double, 5> acts_pull{0.997, 0.996, 0.998, 1.017, 0.993};
  for (std::size_t i = 0; i < 5; ++i) {
    INFO(momentum_state::names[i]);
    CHECK(once.residual[i].standard_deviation() == Approx(acts_deviation[i]).epsilon(close));
    CHECK(once.pull[i].standard_deviation() == Approx(acts_pull[i]).epsilon(close));
  }
  CHECK(once.chi2.mean() == Approx(10.1485).epsilon(close));

  // Where the field hardly bends a track pz has a long tail upwards, which the second pass follows to the minimum of chi2: the standard deviation
  // of pz grows, everything else agrees, chi2 falls, and py loses the excess of its pull.
  for (std::size_t i = 0; i < 4; ++i) {
    INFO(momentum_state::names[i]);
    CHECK(twice.residual[i].standard_deviation() < acts_deviation[i] * (1.0 + close));
    CHECK(twice.pull[i].standard_deviation() == Approx(1.0).epsilon(close));
  }
  CHECK(twice.chi2.mean() < once.chi2.mean());
  CHECK(twice.chi2.mean() == Approx(10.1485).epsilon(close));
  // The linearisation about the first, badly known states leaves the one pass a bias in pz, which two passes have not.
  constexpr double median_over_mean = 1.2533;  // standard errors of the two, Gaussian
  for (std::size_t i = 0; i < 5; ++i) {
    INFO(momentum_state::names[i]);
    CHECK(std::abs(twice.pull[i].median()) < 5.0 * median_over_mean * twice.pull[i].error_of_mean());
  }
  // The core of pz is not touched by its tail.
  CHECK(twice.residual[4].spread() == Approx(once.residual[4].spread()).epsilon(close));
}
