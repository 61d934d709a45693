// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <scifi/event/event.hpp>
#include <scifi/event/truth.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/information/track_bound.hpp>
#include <scifi/material/particle.hpp>
#include <scifi/study/contents.hpp>
#include <scifi/study/efficiency.hpp>
#include <scifi/study/goodness_of_fit.hpp>
#include <scifi/study/momentum_bins.hpp>
#include <scifi/study/momentum_resolution.hpp>
#include <scifi/study/plane_pulls.hpp>
#include <scifi/study/state_residuals.hpp>
#include <scifi/study/track_match.hpp>
#include <scifi/study/true_track.hpp>

namespace scifi::study {

/// What the study of a reconstruction depends on.
struct study_options {
  double field = 0.0;  ///< Bz in the tracker frame, (MeV/c)/(e mm)
  expectation expected{};
  match_window window{};
  momentum_edges edges{};
  momentum_edges wide_edges = wide_momentum_edges();  ///< of the cells in which the momentum is looked at in two dimensions
};

/// Reconstructed tracks of one tracker beside what really flew: efficiency, ghosts, residuals, pulls, goodness of fit.
///
/// Beside the resolutions is the Cramer-Rao bound of each track, from the true state and the true kind of particle. Efficiency and ghosts are of all events. Residuals, pulls and chi2 are those of expected particles that cross all stations and have a track.
/// Studies of parts of the events, with the same options and trackers of the same planes, are merged with +=.
class track_study {
 public:
  track_study(tracker where, study_options options)
      : found(options.edges), momentum(options.edges, options.wide_edges), planes(where, options.field), where_(std::move(where)), options_(std::move(options)) {}

  efficiency found;
  long tracks = 0;      ///< of which the fit went through
  long failed = 0;      ///< fits that stopped
  long ghosts = 0;      ///< tracks of no particle, or of one that has a nearer track
  long duplicates = 0;  ///< of the ghosts, those of a particle that has a nearer track
  long with_tracks = 0; ///< events with tracks
  state_residuals residuals;
  momentum_resolution momentum;
  goodness_of_fit goodness;
  plane_pulls planes;

  /// The particles of an event and its tracks; track points may be missing. What belongs to other trackers is passed over.
  /// Returns the pairs of an expected particle and the index in `e.tracks` of its track, -1 without one.
  std::vector<std::pair<true_track, int>> add(std::span<const crossing> crossings, const event& e) {
    std::vector<true_track> particles = true_tracks(where_, crossings);
    std::vector<const track*> here;
    std::vector<int> index;
    for (std::size_t i = 0; i < e.tracks.size(); ++i) {
      if (e.tracks[i].tracker != where_.id) continue;
      if (!e.tracks[i].status.ok()) {
        ++failed;
        continue;
      }
      here.push_back(&e.tracks[i]);
      index.push_back(static_cast<int>(i));
    }
    const track_match matched = match(particles, here, options_.window);
    tracks += static_cast<long>(here.size());
    with_tracks += here.empty() ? 0 : 1;
    for (const track_kind kind : matched.kind_of) {
      ghosts += kind == track_kind::matched ? 0 : 1;
      duplicates += kind == track_kind::duplicate ? 1 : 0;
    }
    std::vector<std::pair<true_track, int>> pairs;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      if (!particles[i].expected(options_.expected)) continue;
      const int j = matched.track_of[i];
      found.add(particles[i], j >= 0);
      if (j >= 0 && particles[i].complete_stations == static_cast<int>(where_.stations.size())) compare(particles[i], *here[static_cast<std::size_t>(j)], e);
      pairs.emplace_back(std::move(particles[i]), j >= 0 ? index[static_cast<std::size_t>(j)] : -1);
    }
    return pairs;
  }

  track_study& operator+=(const track_study& other) {
    each(merge, other);
    return *this;
  }
  /// Calls visit(part), or visit(part, the same one of `other`), for everything that is merged.
  template <class Visit, class... Others>
  void each(const Visit& visit, const Others&... other) {
    visit(found, other.found...);
    visit(tracks, other.tracks...);
    visit(failed, other.failed...);
    visit(ghosts, other.ghosts...);
    visit(duplicates, other.duplicates...);
    visit(with_tracks, other.with_tracks...);
    visit(residuals, other.residuals...);
    visit(momentum, other.momentum...);
    visit(goodness, other.goodness...);
    visit(planes, other.planes...);
  }

  [[nodiscard]] const tracker& where() const { return where_; }

 private:
  void compare(const true_track& particle, const track& t, const event& e) {
    const reference_bound limit = bound_of(particle);
    residuals.add(particle, t, limit);
    momentum.add(particle, t, limit);
    goodness.add(t);
    planes.add(particle, std::span(e.track_points).subspan(static_cast<std::size_t>(t.first_point), static_cast<std::size_t>(t.points)));
  }

  /// A kind of particle that the library does not know is taken for a muon.
  [[nodiscard]] reference_bound bound_of(const true_track& particle) {
    const int pdg = particle.reference()->pdg_id;
    auto known = bounds_.find(pdg);
    if (known == bounds_.end()) known = bounds_.emplace(pdg, make_track_bound(where_, options_.field, particle_from_pdg(pdg).value_or(muon_plus))).first;
    return known->second(particle.state(), particle.charge);
  }

  tracker where_;
  study_options options_;
  std::map<int, decltype(make_track_bound(std::declval<const tracker&>(), 0.0))> bounds_;  // by the number of the kind of particle
};

}  // namespace scifi::study
