// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/cluster_to_space_point/space_point_finder.hpp>
#include <scifi/digit_to_cluster/cluster_finder.hpp>
#include <scifi/event/event.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/study/channel_sums.hpp>
#include <scifi/study/contents.hpp>
#include <scifi/study/occupancy.hpp>
#include <scifi/study/track_study.hpp>

namespace scifi::study_program {

/// Everything that is known of one tracker, or of several together.
struct tracker_results {
  study::track_study tracks;
  study::occupancy seen;
  study::channel_sums sums;

  tracker_results(const tracker& where, const study::study_options& options) : tracks(where, options), sums(where) {}

  tracker_results& operator+=(const tracker_results& other) {
    each(study::merge, other);
    return *this;
  }
  /// Calls visit(part), or visit(part, the same one of `other`), for everything that is merged.
  template <class Visit, class... Others>
  void each(const Visit& visit, const Others&... other) {
    visit(tracks, other.tracks...);
    visit(seen, other.seen...);
    visit(sums, other.sums...);
  }
};

/// Clusters and space points of the digits of an event, as the standard chain makes them, but each cluster in one triplet at most, the best: what a
/// reader of the numbers takes a space point for.
class front_half {
 public:
  front_half(const detector& where, double min_npe, const fibre_doublet& fibre) : where_(where) {
    clusters_.min_npe = min_npe;
    clusters_.resolution.fibre = fibre;
  }

  void operator()(event& e) {
    e.clusters.clear();
    e.space_points.clear();
    clusters_(where_, e.digits, e.clusters);
    for (const tracker& t : where_.trackers) points_(t, e.clusters, e.space_points, work_);
  }

 private:
  const detector& where_;
  cluster_finder<fibre_resolution> clusters_;
  space_point_finder points_;
  space_point_finder::buffers work_;
};

}  // namespace scifi::study_program
