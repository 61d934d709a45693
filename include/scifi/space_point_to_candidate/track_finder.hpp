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
#include <scifi/space_point_to_candidate/joint_choice.hpp>
#include <scifi/space_point_to_candidate/station_scattering.hpp>
#include <scifi/space_point_to_candidate/track_finder_options.hpp>

namespace scifi {

/// Space points to candidates: helices in a field, straight lines without.
///
/// Three stations give a hypothesis: the chord from the second to the third point is turned against the one from the first to the second by
/// w (z3 - z1)/2 modulo a turn, and their lengths must agree; each full turn is a hypothesis of its own, which the unequal distances of the stations tell
/// apart. Where the chords go on shows which points of the next station are worth an arc fit; the arc fit predicts that station, only points inside its gate are
/// followed. All stations first, then one less, down to `min_stations`, each with tight cuts and then with wide ones, from points still free; candidates that
/// compete for clusters are ranked by chi2 - gain x clusters.
///
/// Where points crowd, sure_search goes before all that, twice, and its candidates are chosen as a set (select_jointly).
class track_finder {
 public:
  /// Throws std::invalid_argument where the options make no sense, or check(tracker) refuses the tracker.
  template <class Scattering>
  track_finder(const tracker& where, const track_finder_options& options, const particle& hypothesis, const Scattering& scattering)
      : setting_(where, checked(options), hypothesis, scattering) {}

  /// Working memory, to be handed in again.
  struct buffers {
    search_buffers search;
    disjoint_buffers disjoint;
    joint_buffers joint;
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
    const auto choose = [&] {
      select_disjoint(work.search.found, points, setting_.options.cluster_gain, setting_.options.max_shared_clusters, work.search.cluster_used, candidates, work.disjoint);
    };
    // What the first choice leaves of the crowd may be searched with the tight cut.
    for (const double chi2_per_ndf : {setting_.options.sure_chi2_per_ndf, setting_.options.tight_chi2_per_ndf}) {
      if (!search.sure(chi2_per_ndf)) break;
      select_jointly(work.search.found, points, {setting_.options.cluster_gain, setting_.options.max_shared_of_sure}, work.search.cluster_used, candidates, work.joint);
    }
    for (int size = static_cast<int>(setting_.stations.size()); size >= std::max(3, setting_.options.min_stations); --size) {
      for (const bool tight : {true, false}) {
        search(size, tight);
        choose();
      }
    }
    return search.complete();
  }

 private:
  [[nodiscard]] static const track_finder_options& checked(const track_finder_options& options) {
    options.check();
    return options;
  }
  search_setting setting_;
};

}  // namespace scifi
