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

}  // namespace scifi
