// SPDX-License-Identifier: MPL-2.0
// From digits to tracks, arrow by arrow: every stage called by hand, with a look at what it made, then the standard chain, which does the same in one call.
// Fails where the two differ or the muon is not found.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <scifi/chain/reconstruction.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/hit_to_digit/digitiser.hpp>
#include <scifi/particle_to_hit/gun.hpp>
#include <scifi/particle_to_hit/transport.hpp>

namespace {

using scifi::momentum_state;
constexpr double field = 3.0 * scifi::units::tesla;

/// The digits that one muon leaves in a tracker, noise among them.
std::vector<scifi::digit> digits_of_a_muon(const scifi::tracker& where) {
  scifi::transport_settings settings;
  settings.field = field;
  const scifi::transport fly(where, settings, scifi::coulomb_scattering{}, scifi::collision_loss{});
  scifi::random_stream random(9, 1, static_cast<std::uint32_t>(where.id));
  scifi::flat_beam beam;
  beam.radius = 60.0;
  beam.pt_min = 30.0;
  beam.pt_max = 40.0;
  scifi::truth truth;
  fly(beam.shoot(where, random), 1, random, truth);
  std::vector<scifi::raw_digit> read_out;
  scifi::digitiser<>{}(where, truth.hits, random, read_out);
  std::vector<scifi::digit> digits;
  for (const scifi::raw_digit& d : read_out) digits.push_back(d.seen());
  return digits;
}

}  // namespace

int main() {
  const scifi::detector mice = scifi::mice::trackers();
  const scifi::tracker& where = mice.trackers[1];
  std::vector<scifi::digit> digits = digits_of_a_muon(where);
  const std::vector<scifi::digit> as_read = digits;
  std::printf("%zu digits\n", digits.size());

  // [clusters]
  const scifi::cluster_finder find_clusters;  // of fibres, with their resolution
  std::vector<scifi::cluster> clusters;
  find_clusters(mice, digits, clusters);
  // [clusters]
  std::printf("%zu clusters; the first: station %d, plane %d, alpha %.2f +- %.2f mm\n", clusters.size(), clusters[0].station, clusters[0].plane, clusters[0].alpha,
              std::sqrt(clusters[0].variance));

  // [points]
  scifi::space_point_finder find_points;
  find_points.use = scifi::cluster_use::shared;  // all triplets that agree; the next stage chooses among them
  scifi::space_point_finder::buffers point_buffers;
  std::vector<scifi::space_point> points;
  find_points(where, clusters, points, point_buffers);
  // [points]
  for (const scifi::space_point& p : points) std::printf("  station %d: %7.2f %7.2f mm\n", p.station, p.position.x(), p.position.y());

  // [candidates]
  scifi::track_finder_options finding;
  finding.field = field;
  const scifi::track_finder find_tracks(where, finding, scifi::muon_plus, scifi::highland_scattering{});
  scifi::track_finder::buffers finder_buffers;
  std::vector<scifi::candidate> candidates;
  find_tracks(points, clusters.size(), candidates, finder_buffers);
  // [candidates]
  std::printf("%zu candidate\n", candidates.size());
  if (candidates.size() != 1) return 1;

  // [fit]
  scifi::track_fit_options fitting;
  fitting.field = field;
  const scifi::track_fitter fit(where, fitting, scifi::muon_plus, scifi::mean_energy_loss{}, scifi::highland_scattering{}, scifi::landau_straggling{5.0});
  decltype(fit)::buffers fit_buffers;
  std::vector<scifi::track> tracks;
  std::vector<scifi::track_point> track_points;
  fit(candidates[0], 0, points, clusters, tracks, track_points, fit_buffers);
  // [fit]
  const scifi::track& t = tracks[0];
  if (!t.status.ok()) return 1;
  const auto& mean = t.reference.mean;
  std::printf("a track of %d planes, chi2 %.1f for %d; at z = %.1f mm: x %.2f, y %.2f mm, p (%.1f, %.1f, %.1f) MeV/c\n", t.planes, t.chi2, t.ndf, t.z,
              mean[momentum_state::x], mean[momentum_state::y], mean[momentum_state::px], mean[momentum_state::py], mean[momentum_state::pz]);

  // [chain]
  scifi::event e;
  e.digits = as_read;
  scifi::reconstruction_options options;
  options.field = field;
  scifi::make_reconstruction(mice, options)(e);
  // [chain]
  if (e.tracks.size() != 1 || e.clusters.size() != clusters.size() || e.space_points.size() != points.size()) return 1;
  // The chain looks again at tracks that fit badly; this one fits.
  const double difference = (e.tracks[0].reference.mean - mean).norm();
  std::printf("the chain in one call differs by %.1e\n", difference);
  return difference < 1e-9 ? 0 : 1;
}
