// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <scifi/event/candidate.hpp>
#include <scifi/event/space_point.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/space_point_to_candidate/combination_search.hpp>
#include <scifi/space_point_to_candidate/disjoint.hpp>
#include <scifi/space_point_to_candidate/station_scattering.hpp>
#include <scifi/space_point_to_candidate/track_finder_options.hpp>

namespace scifi {

/// Space points to candidates: helices in a field, straight lines without.
///
/// Three stations give a hypothesis: the chord from the second to the third point is turned against the one from the first to the second by
/// w (z3 - z1)/2 modulo a turn, and their lengths must agree; each full turn is a hypothesis of its own, which the unequal distances of the stations tell
/// apart. The arc fit predicts the next station, only points inside its gate are followed. All stations first, then one less, down to
/// `min_stations`, each with tight cuts and then with wide ones, from points still free; candidates that compete for clusters are ranked
/// by chi2 - gain x clusters.
class track_finder {
 public:
  /// Throws std::invalid_argument where the options make no sense.
  template <class Scattering>
  track_finder(const tracker& where, const track_finder_options& options, const particle& hypothesis, const Scattering& scattering)
      : setting_{where.id, where.beam_direction, {}, station_scattering(where, hypothesis, scattering), options} {
    options.check();
    for (const station& s : where.stations) setting_.stations.push_back(s.id);
  }

  /// Working memory, to be handed in again.
  struct buffers {
    search_buffers search;
    disjoint_buffers disjoint;
  };

  /// Appends the candidates of the tracker. `clusters` is their number in the event. Returns false when the bound on the search was reached.
  bool operator()(std::span<const space_point> points, std::size_t clusters, std::vector<candidate>& candidates, buffers& work) const {
    work.search.points.resize(setting_.stations.size());
    work.search.cluster_used.assign(clusters, 0);
    work.search.arc_points.clear();
    for (const space_point& p : points) {
      const double variance = 0.5 * (p.covariance(0, 0) + p.covariance(1, 1));
      work.search.arc_points.push_back({{p.position.x(), p.position.y()}, variance, p.z});
    }
    combination_search search(setting_, points, work.search);
    for (int size = static_cast<int>(setting_.stations.size()); size >= std::max(3, setting_.options.min_stations); --size) {
      for (const bool tight : {true, false}) {
        search(size, tight);
        select_disjoint(work.search.found, points, setting_.options.cluster_gain, setting_.options.max_shared_clusters, work.search.cluster_used, candidates, work.disjoint);
      }
    }
    return search.complete();
  }

 private:
  search_setting setting_;
};

}  // namespace scifi
