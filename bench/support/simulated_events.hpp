// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <scifi/digit_to_cluster/cluster_finder.hpp>
#include <scifi/event/event.hpp>
#include <scifi/event/truth.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/hit_to_digit/digitiser.hpp>
#include <scifi/cluster_to_space_point/space_point_finder.hpp>
#include <scifi/particle_to_hit/gun.hpp>
#include <scifi/particle_to_hit/transport.hpp>

namespace simulated {

/// What pattern recognition would get from space points without ghosts: those of each particle alone, found without noise.
struct true_points {
  std::vector<scifi::space_point> points;
  std::size_t clusters = 0;
  std::vector<int> particle_of;  // for each point
};

/// One event: muons through one tracker, their digits with noise, what really flew, and the space points of each particle alone.
struct one_event {
  std::vector<scifi::digit> digits;
  std::vector<scifi::crossing> crossings;
  true_points truth;
};

inline std::vector<scifi::digit> digits_of(const scifi::tracker& t, std::span<const scifi::hit> hits, const scifi::digitiser<>& digitise, scifi::random_stream random) {
  std::vector<scifi::raw_digit> raw;
  digitise(t, hits, random, raw);
  std::vector<scifi::digit> out;
  for (const scifi::raw_digit& d : raw) out.push_back(d.seen());
  return out;
}

/// Muons of 100 to 280 MeV/c along z and up to 70 MeV/c across it, spread over a disc of 110 mm.
inline one_event draw(const scifi::detector& where, double field, int particles, std::uint64_t number) {
  const scifi::tracker& t = where.trackers.front();
  scifi::transport_settings settings;
  settings.field = field;
  const scifi::transport fly(t, settings, scifi::coulomb_scattering{}, scifi::collision_loss{});
  scifi::flat_beam beam;
  beam.pt_max = 70.0;
  scifi::digitiser<> noisy, quiet;
  quiet.noise.rate = 0.0;
  const scifi::cluster_finder<> find_clusters;
  const scifi::space_point_finder find_points;
  scifi::space_point_finder::buffers work;

  one_event out;
  std::vector<scifi::hit> hits;
  for (int i = 1; i <= particles; ++i) {
    scifi::random_stream random(1001, number, static_cast<std::uint32_t>(particles), static_cast<std::uint32_t>(i));
    scifi::truth real;
    real.last_particle = particles;
    fly(beam.shoot(t, random), i, random, real);
    hits.insert(hits.end(), real.hits.begin(), real.hits.end());
    out.crossings.insert(out.crossings.end(), real.crossings.begin(), real.crossings.end());

    scifi::event alone;
    alone.digits = digits_of(t, real.hits, quiet, random);
    find_clusters(where, alone.digits, alone.clusters);
    find_points(t, alone.clusters, alone.space_points, work);
    for (scifi::space_point p : alone.space_points) {
      for (int& cluster : p.clusters) cluster += static_cast<int>(out.truth.clusters);
      out.truth.points.push_back(p);
      out.truth.particle_of.push_back(i);
    }
    out.truth.clusters += alone.clusters.size();
  }
  out.digits = digits_of(t, hits, noisy, scifi::random_stream(1002, number, static_cast<std::uint32_t>(particles)));
  return out;
}

}  // namespace simulated
