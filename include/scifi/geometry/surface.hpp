// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <scifi/geometry/tracker.hpp>

namespace scifi {

/// One measuring surface of a tracker, with everything a fit needs of it, in the tracker frame.
///
/// alpha = cos_angle x + sin_angle y - offset for a point (x, y) of the tracker frame (mm); the station's shift and rotation are inside.
struct surface {
  int station = 0;           ///< station id, 1..
  int plane = 0;             ///< plane number in its station, 0..
  double z = 0.0;            ///< where alpha is measured, mm
  double z_reference = 0.0;  ///< outer surface of the plane on the side of smaller z, mm
  double cos_angle = 1.0;
  double sin_angle = 0.0;
  double offset = 0.0;  ///< mm
  slab_stack<4> below;  ///< material between z_reference and z, in order of growing z
  slab_stack<4> above;  ///< material between z and the far surface of the plane, in order of growing z

  /// Coordinate that the surface measures at the point (x, y) of the tracker frame, mm.
  [[nodiscard]] double tracker_to_alpha(double x, double y) const { return cos_angle * x + sin_angle * y - offset; }
};

/// The surfaces of a tracker in the order in which something that travels along `direction` (+1: growing z, -1: falling z) meets them.
/// The stacks keep their order of growing z: a traveller in the other direction meets `above` first.
[[nodiscard]] inline std::vector<surface> surfaces_along(const tracker& t, int direction) {
  std::vector<surface> out;
  for (const station& s : t.stations) {
    for (std::size_t i = 0; i < s.planes.size(); ++i) {
      const plane& p = s.planes[i];
      const double angle = p.angle + s.in_tracker.angle;
      surface f;
      f.station = s.id;
      f.plane = static_cast<int>(i);
      f.z = s.in_tracker.origin.z() + p.z_measured;
      f.z_reference = s.in_tracker.origin.z() + p.z_reference;
      f.cos_angle = std::cos(angle);
      f.sin_angle = std::sin(angle);
      f.offset = f.cos_angle * s.in_tracker.origin.x() + f.sin_angle * s.in_tracker.origin.y();
      f.below = p.below;
      f.above = p.above;
      out.push_back(f);
    }
  }
  std::sort(out.begin(), out.end(), [direction](const surface& a, const surface& b) { return direction > 0 ? a.z < b.z : a.z > b.z; });
  return out;
}

}  // namespace scifi
