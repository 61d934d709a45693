// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <scifi/candidate_to_track/track_fitter.hpp>
#include <scifi/cluster_to_space_point/space_point_finder.hpp>
#include <scifi/digit_to_cluster/cluster_finder.hpp>
#include <scifi/event/event.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/material/straggling.hpp>
#include <scifi/space_point_to_candidate/track_finder.hpp>

namespace scifi {

/// The stages that work on one tracker.
template <class CandidateFinder, class TrackFitter>
struct tracker_stages {
  tracker where;
  CandidateFinder find_candidates;
  TrackFitter fit_track;
};

/// The whole chain as a value: digits -> clusters -> space points -> candidates -> tracks. Every stage is a type of its own and can be replaced.
///
/// Const calls; threads share one chain, each with its own `buffers` and events.
template <class ClusterFinder, class SpacePointFinder, class CandidateFinder, class TrackFitter>
class reconstruction {
 public:
  using stages = scifi::tracker_stages<CandidateFinder, TrackFitter>;

  /// Memory that the stages work in. Handed in again it stops growing, and reconstruction no longer allocates.
  struct buffers {
    typename SpacePointFinder::buffers space_points;
    typename CandidateFinder::buffers candidates;
    typename TrackFitter::buffers fit;
    std::vector<std::size_t> first_candidates;  ///< for each event, of each tracker, and where the last one ends
    std::vector<fit_job> jobs;
    std::vector<fitted_track> fitted;
  };

  reconstruction(detector where, ClusterFinder clusters, SpacePointFinder points, std::vector<stages> trackers)
      : where_(std::move(where)), find_clusters_(std::move(clusters)), find_points_(std::move(points)), trackers_(std::move(trackers)) {}

  /// Fills the event (any event_record) from its digits, which are sorted on the way. What was reconstructed before is replaced.
  template <class Event>
  void operator()(Event& e, buffers& work) const {
    (*this)(std::span<Event>(&e, 1), work);
  }

  /// The same for a block of events: their tracks are fitted together, where the fitter can one in each SIMD lane.
  template <class Event>
  void operator()(std::span<Event> events, buffers& work) const {
    static_assert(event_record<Event>,
                  "scifi: an event needs members digits (with channel_of and light_of beside their type), clusters, space_points, candidates, tracks, "
                  "track_points and flags");
    work.first_candidates.clear();
    for (Event& e : events) {
      clear_reconstruction(e);
      e.flags.digits_left_out = !find_clusters_(where_, e.digits, e.clusters);
      for (const stages& s : trackers_) {
        work.first_candidates.push_back(e.candidates.size());
        const bool points_complete = find_points_(s.where, e.clusters, e.space_points, work.space_points);
        const bool candidates_complete = s.find_candidates(e.space_points, e.clusters.size(), e.candidates, work.candidates);
        e.flags.combinations_limited |= !points_complete || !candidates_complete;
      }
      work.first_candidates.push_back(e.candidates.size());
    }
    for (std::size_t t = 0; t < trackers_.size(); ++t) fit_tracks(trackers_[t], t, events, work);
  }

  /// The same with memory of its own for this call.
  template <class Event>
  void operator()(Event& e) const {
    buffers work;
    (*this)(e, work);
  }

  [[nodiscard]] const detector& where() const { return where_; }
  /// The stages of each tracker, in the order of the detector's.
  [[nodiscard]] const std::vector<stages>& trackers() const { return trackers_; }
  /// The stages before those, shared by all trackers.
  [[nodiscard]] const ClusterFinder& clusters() const { return find_clusters_; }
  [[nodiscard]] const SpacePointFinder& space_points() const { return find_points_; }

 private:
  /// Fits what was found in one tracker in all events, and appends it to them.
  template <class Event>
  void fit_tracks(const stages& s, std::size_t tracker, std::span<Event> events, buffers& work) const {
    work.jobs.clear();
    const auto each_candidate = [&](const auto& f) {
      const std::size_t* first = work.first_candidates.data() + tracker;
      for (Event& e : events) {
        for (std::size_t i = first[0]; i < first[1]; ++i) f(e, i);
        first += trackers_.size() + 1;
      }
    };
    const auto judge = [&s](Event& e) {
      e.flags.fit_failed |= !e.tracks.back().status.ok();
      if (!left_before_reference(e.tracks.back(), s.where)) return;
      e.track_points.resize(static_cast<std::size_t>(e.tracks.back().first_point));
      e.tracks.pop_back();
    };
    if constexpr (requires { s.fit_track.fit_batch(work.jobs, work.fitted, work.fit); }) {
      each_candidate([&work](Event& e, std::size_t i) { work.jobs.push_back({&e.candidates[i], static_cast<int>(i), e.space_points, e.clusters}); });
      s.fit_track.fit_batch(work.jobs, work.fitted, work.fit);
      std::size_t next = 0;
      each_candidate([&](Event& e, std::size_t) {
        append(work.fitted[next++], e.tracks, e.track_points);
        judge(e);
      });
    } else {
      each_candidate([&](Event& e, std::size_t i) {
        s.fit_track(e.candidates[i], static_cast<int>(i), e.space_points, e.clusters, e.tracks, e.track_points, work.fit);
        judge(e);
      });
    }
  }

  /// A particle that entered at the far end and left through the side never was at the reference surface, and a state there would be an invention.
  /// Its candidate stays in the event.
  [[nodiscard]] static bool left_before_reference(const track& t, const tracker& where) {
    if (!t.status.ok()) return false;
    const auto& at = t.reference;
    const double radius = std::hypot(at.mean[momentum_state::x], at.mean[momentum_state::y]);
    const double error = std::sqrt(std::max(at.covariance(momentum_state::x, momentum_state::x), at.covariance(momentum_state::y, momentum_state::y)));
    return radius > where.active_radius + 3.0 * error;
  }

  detector where_;
  ClusterFinder find_clusters_;
  SpacePointFinder find_points_;
  std::vector<stages> trackers_;
};

/// What a user chooses for the chain of the fibre trackers; everything else has its documented default in the stage.
struct reconstruction_options {
  double field = 0.0;               ///< Bz in the tracker frames, (MeV/c)/(e mm): tesla times units::tesla; zero: straight tracks
  particle hypothesis = muon_plus;  ///< mass for scattering and energy loss; the charge is found in a field
  double min_npe = 2.0;             ///< photo-electrons
  double line_momentum = 200.0;     ///< MeV/c along z, assumed for straight tracks
  fibre_doublet fibre{};            ///< what the planes are made of, for the resolution of clusters
};

/// How a chain lets bent tracks fly in one tracker.
template <class Flight>
struct tracker_flight {
  Flight flight;       ///< propagator of slope_state for the fit, in the tracker frame: helix_propagator, nystrom_propagator
  double field = 0.0;  ///< mean of Bz on the axis, (MeV/c)/(e mm): pattern recognition takes its helix; zero: straight tracks
};

/// The stages of the standard chain, for bent tracks that fly so.
template <class Flight>
using standard_fitter = track_fitter<mean_energy_loss, highland_scattering, landau_straggling, kalman::symmetric_form, kalman::no_gate, Flight, robust_refit, fibre_probability>;
/// What make_reconstruction returns, for a class that keeps one as a member; in a uniform field `standard_reconstruction<>`.
template <class Flight = helix_propagator>
using standard_reconstruction = reconstruction<cluster_finder<fibre_resolution>, space_point_finder, track_finder, standard_fitter<Flight>>;

/// The standard chain for trackers of scintillating fibres, with `flight_in(tracker)`, a tracker_flight, in each tracker; `options.field` is not asked.
template <class FlightIn>
[[nodiscard]] auto make_reconstruction(const detector& where, const reconstruction_options& options, const FlightIn& flight_in) {
  static_assert(requires(const tracker& t) { flight_in(t).flight; flight_in(t).field; },
                "scifi: flight_in(tracker) must return a tracker_flight: the propagator of slope_state there, and the mean of Bz");
  const highland_scattering scattering;
  // Of the mean loss: pz is known much worse than losses fluctuate, so that the tail of the losses moves the middle of its errors as it moves their mean.
  const mean_energy_loss loss;
  // The width is that of the core of the loss over all stations, each one layer.
  std::size_t stations = 1;
  for (const tracker& t : where.trackers) stations = std::max(stations, t.stations.size());
  const landau_straggling straggling{static_cast<double>(stations)};
  using fitter = standard_fitter<decltype(flight_in(std::declval<const tracker&>()).flight)>;

  track_finder_options finding;
  finding.line_momentum = options.line_momentum;
  finding.line_charge = options.hypothesis.charge < 0 ? -1 : 1;
  track_fit_options fitting;
  fitting.line_momentum = options.line_momentum;
  fitting.prior = finding.prior;

  cluster_finder<fibre_resolution> clusters;
  clusters.min_npe = options.min_npe;
  clusters.resolution.fibre = options.fibre;
  // Pattern recognition chooses among all consistent triplets: with several tracks the best crossing of a station alone is not always the true one.
  space_point_finder points;
  points.use = cluster_use::shared;
  std::vector<tracker_stages<track_finder, fitter>> trackers;
  for (const tracker& t : where.trackers) {
    const auto fly = flight_in(t);
    finding.field = fitting.field = fly.field;
    finding.min_stations = fly.field != 0.0 ? 4 : 3;
    trackers.push_back({t, track_finder(t, finding, options.hypothesis, scattering),
                        fitter(t, fitting, options.hypothesis, loss, scattering, straggling, kalman::symmetric_form{}, kalman::no_gate{}, fly.flight)});
  }
  return reconstruction(where, clusters, points, std::move(trackers));
}

/// The same in a uniform field.
[[nodiscard]] inline auto make_reconstruction(const detector& where, const reconstruction_options& options) {
  return make_reconstruction(where, options, [field = options.field](const tracker&) { return tracker_flight<helix_propagator>{{field}, field}; });
}

}  // namespace scifi
