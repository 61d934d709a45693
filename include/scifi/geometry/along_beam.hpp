// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <vector>

#include <scifi/core/linalg.hpp>
#include <scifi/geometry/tracker.hpp>

namespace scifi {

/// Where a drawing of several trackers puts one of them: in the drawing's frame the beam travels towards +z. A tracker whose own frame the beam
/// crosses towards -z is turned by 180 degrees about y, which keeps the sense of rotation of every helix.
struct placed_along_beam {
  int tracker = 0;
  double sense = 1.0;  ///< +1, or -1 for one that is turned
  double shift = 0.0;  ///< of its origin along z of the drawing, mm

  /// A point of the tracker frame in the frame of the drawing (mm).
  [[nodiscard]] vector<double, 3> tracker_to_drawing(const vector<double, 3>& point) const {
    return {sense * point.x(), point.y(), sense * point.z() + shift};
  }
};

/// The trackers of a detector one behind the other, in their order, `gap` (mm) apart; the first station that the beam meets is at z = 0. Their
/// true distance is not part of a geometry.
[[nodiscard]] inline std::vector<placed_along_beam> along_beam(const detector& d, double gap) {
  std::vector<placed_along_beam> out;
  double next = 0.0;
  for (const tracker& t : d.trackers) {
    if (t.stations.empty()) continue;
    const auto lower = [](const station& a, const station& b) { return a.in_tracker.origin.z() < b.in_tracker.origin.z(); };
    const auto [first, last] = std::minmax_element(t.stations.begin(), t.stations.end(), lower);
    const double low = first->in_tracker.origin.z();
    const double high = last->in_tracker.origin.z();
    out.push_back(t.beam_direction > 0 ? placed_along_beam{t.id, 1.0, next - low} : placed_along_beam{t.id, -1.0, next + high});
    next += high - low + gap;
  }
  return out;
}

}  // namespace scifi
