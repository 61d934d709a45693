// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <scifi/core/linalg.hpp>
#include <scifi/geometry/tracker.hpp>

namespace scifi {

/// A piece of a straight line, tracker frame, mm.
struct line_segment {
  vector<double, 3> from = vector<double, 3>::Zero();
  vector<double, 3> to = vector<double, 3>::Zero();
};

/// The line along which the fibres of a (possibly fractional) channel run, from edge to edge of the active area (`radius`, mm, about the axis of the
/// station): alpha is that of the channel, beta goes from -b to +b with b = sqrt(radius^2 - alpha^2). Of no length for a channel beyond the radius.
[[nodiscard]] inline line_segment line_of_channel(const station& s, const plane& p, double channel, double radius) {
  const double alpha = p.alpha(channel);
  const double half = std::sqrt(std::max(0.0, radius * radius - alpha * alpha));
  const auto in_tracker = [&](double beta) { return s.in_tracker.child_to_parent(p.in_station().child_to_parent({alpha, beta, 0.0})); };
  return {in_tracker(-half), in_tracker(half)};
}

}  // namespace scifi
