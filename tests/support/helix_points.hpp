// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <vector>

#include <scifi/core/units.hpp>
#include <scifi/event/candidate.hpp>
#include <scifi/event/space_point.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/space_point_to_candidate/search_trial.hpp>
#include <scifi/track_model/helix_propagator.hpp>

namespace scifi::test {

/// Space points of exact helices in the downstream tracker in 3 T, five each, of three clusters of their own, and what a search for them needs.
struct helix_points {
  tracker where = mice::trackers().trackers[mice::downstream];
  search_setting setting;
  std::vector<space_point> points;
  search_buffers work;

  helix_points() : setting(where, options(), muon_plus, highland_scattering{}) {}

  static track_finder_options options() {
    track_finder_options o;
    o.field = 3.0 * units::tesla;
    return o;
  }

  void add(const vector<double, 5>& start) {
    for (const station& s : where.stations) {
      space_point p;
      p.tracker = where.id;
      p.station = s.id;
      p.z = s.in_tracker.origin.z() + 1.0;
      const vector<double, 5> at = helix_propagator{options().field}.propagate(start, p.z).state;
      p.position = {at[slope_state::x], at[slope_state::y]};
      p.covariance = 0.12 * matrix<double, 2, 2>::Identity();
      p.npe = 36.0;
      for (int i = 0; i < 3; ++i) p.clusters.push_back(static_cast<int>(3 * points.size()) + i);
      points.push_back(p);
    }
  }
  void add(double x, double tx, double y, double ty, double q_over_pz) {
    vector<double, 5> start;
    start << x, tx, y, ty, q_over_pz;
    add(start);
  }

  /// Once all are added.
  void prepare() {
    work.arc_points.clear();
    for (const space_point& p : points) work.arc_points.push_back({{p.position.x(), p.position.y()}, 0.12, p.z});
    work.points.resize(setting.stations.size());
    work.cluster_used.assign(points.size() * 3, 0);
  }

  /// True if the candidate's points are those of one helix.
  static bool pure(const candidate& c) {
    for (const int point : c.space_points)
      if (point / 5 != c.space_points[0] / 5) return false;
    return true;
  }
};

}  // namespace scifi::test
