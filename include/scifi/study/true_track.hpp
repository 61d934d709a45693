// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <scifi/core/linalg.hpp>
#include <scifi/event/truth.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/material/particle.hpp>
#include <scifi/track_model/helix_state.hpp>

namespace scifi::study {

/// Of which particles a track is expected: of those that cross all planes of at least so many stations, station 1 among them, within the fiducial
/// radius of the tracker, and whose pt/|pz| at the reference surface stays below a limit.
struct expectation {
  int min_stations = 4;
  double max_pt_over_pz = 0.5;
};

/// A particle of a simulation in one tracker.
struct true_track {
  int particle = 0;
  int charge = 0;             ///< sign
  int complete_stations = 0;  ///< of which it crosses every plane within the fiducial radius
  bool first_complete = false;  ///< the first station is one of them
  /// Its crossing of each plane, in order of growing z, or nullptr; of several crossings of a plane the last. They belong to who gave them.
  std::vector<const crossing*> at;

  /// Crossing of the reference surface of the tracker, or nullptr.
  [[nodiscard]] const crossing* reference() const { return at.front(); }
  /// Transverse momentum there, MeV/c; only with a reference.
  [[nodiscard]] double pt() const { return std::hypot(reference()->momentum.x(), reference()->momentum.y()); }
  /// momentum_state there; only with a reference.
  [[nodiscard]] vector<double, 5> state() const {
    const crossing& c = *reference();
    vector<double, 5> out;
    out << c.position.x(), c.position.y(), c.momentum.x(), c.momentum.y(), c.momentum.z();
    return out;
  }
  [[nodiscard]] bool expected(const expectation& of) const {
    return reference() != nullptr && first_complete && complete_stations >= of.min_stations && pt() < of.max_pt_over_pz * std::abs(reference()->momentum.z());
  }
};

/// The particles with crossings in this tracker, in order of their numbers. Crossings of other trackers are passed over, as are planes it does not have.
[[nodiscard]] inline std::vector<true_track> true_tracks(const tracker& where, std::span<const crossing> crossings) {
  std::size_t planes = 0;
  for (const station& s : where.stations) planes += s.planes.size();
  std::vector<true_track> out;
  for (const crossing& c : crossings) {
    if (c.tracker != where.id) continue;
    std::size_t place = 0;
    std::size_t s = 0;
    for (; s < where.stations.size() && where.stations[s].id != c.station; ++s) place += where.stations[s].planes.size();
    if (s == where.stations.size() || c.plane < 0 || static_cast<std::size_t>(c.plane) >= where.stations[s].planes.size()) continue;
    auto of = std::lower_bound(out.begin(), out.end(), c.particle, [](const true_track& t, int particle) { return t.particle < particle; });
    if (of == out.end() || of->particle != c.particle) {
      const auto species = particle_from_pdg(c.pdg_id);
      of = out.insert(of, {c.particle, species ? (species->charge > 0 ? 1 : -1) : (c.pdg_id > 0 ? 1 : -1), 0, false, std::vector<const crossing*>(planes, nullptr)});
    }
    of->at[place + static_cast<std::size_t>(c.plane)] = &c;
  }
  for (true_track& t : out) {
    std::size_t place = 0;
    for (std::size_t s = 0; s < where.stations.size(); ++s) {
      bool complete = true;
      for (std::size_t p = 0; p < where.stations[s].planes.size(); ++p, ++place) {
        const crossing* c = t.at[place];
        complete = complete && c != nullptr && std::hypot(c->position.x(), c->position.y()) < where.fiducial_radius;
      }
      t.complete_stations += complete ? 1 : 0;
      if (s == 0) t.first_complete = complete;
    }
  }
  return out;
}

}  // namespace scifi::study
