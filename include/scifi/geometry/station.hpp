// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <vector>

#include <scifi/geometry/placement.hpp>
#include <scifi/geometry/plane.hpp>

namespace scifi {

/// A group of planes close together in z; its origin is the reference surface of its first plane.
struct station {
  int id = 1;                 ///< 1 is the one with the smallest z
  placement in_tracker;       ///< where the station frame sits in the tracker frame
  std::vector<plane> planes;  ///< in order of growing z

  /// Sum of the channel numbers of a point's clusters in planes that close to zero (sum of alpha = 0), Kuno's conjecture:
  /// sum of central channels; meaningful for three planes at 120 degrees with one channel width.
  [[nodiscard]] double channel_sum() const {
    double sum = 0.0;
    for (const plane& p : planes) sum += p.central_channel;
    return sum;
  }
};

/// Makes all planes of a station one layer to the logarithms of Highland's formula and of the most probable loss: a track scatters in the station
/// as a whole before anything far away sees it (Highland's formula holds for the sum, not for the parts; PDG 2024, remark below eq. 34.16).
inline void as_one_layer(station& s) {
  double total = 0.0;
  for (const plane& p : s.planes) total += radiation_lengths(p.below) + radiation_lengths(p.above);
  const auto share = [total](const slab_stack<4>& stack) {
    slab_stack<4> out;
    for (const slab& slice : stack) out.add({slice.medium, slice.thickness, total});
    return out;
  };
  for (plane& p : s.planes) {
    p.below = share(p.below);
    p.above = share(p.above);
  }
}

}  // namespace scifi
