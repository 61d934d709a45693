// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <tuple>
#include <vector>

#include <scifi/event/cluster.hpp>
#include <scifi/geometry/surface.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/track_model/helix_propagator.hpp>

namespace scifi::test {

/// What a plane would say of a point of the tracker frame if its channels were infinitely fine: alpha without error, its usual variance.
inline cluster ideal_cluster(const tracker& t, const surface& at, double x, double y, double npe = 10.0) {
  cluster c;
  c.tracker = t.id;
  c.station = at.station;
  c.plane = at.plane;
  c.alpha = at.tracker_to_alpha(x, y);
  for (const station& s : t.stations) {
    if (s.id != at.station) continue;
    const plane& p = s.planes[static_cast<std::size_t>(at.plane)];
    c.channel = p.channel_at(c.alpha);
    c.variance = p.channel_width * p.channel_width / 12.0;
  }
  c.npe = npe;
  c.size = 1;
  return c;
}

/// In the order in which the cluster finder leaves them.
inline void sort_clusters(std::vector<cluster>& clusters) {
  std::sort(clusters.begin(), clusters.end(), [](const cluster& a, const cluster& b) {
    return std::tuple(a.tracker, a.station, a.plane, a.channel) < std::tuple(b.tracker, b.station, b.plane, b.channel);
  });
}

/// Appends the clusters of a track that is `start` at z = 0 and neither scatters nor slows.
inline void add_ideal_track(const tracker& t, const vector<double, 5>& start, double field, std::vector<cluster>& clusters) {
  const helix_propagator flight{field};
  for (const surface& s : surfaces_along(t, +1)) {
    const vector<double, 5> here = flight.propagate(start, s.z).state;
    clusters.push_back(ideal_cluster(t, s, here[slope_state::x], here[slope_state::y]));
  }
}

}  // namespace scifi::test
