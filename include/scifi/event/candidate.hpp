// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/inline_vector.hpp>
#include <scifi/kalman/estimate.hpp>

namespace scifi {

/// Stations that a candidate can have.
inline constexpr int max_stations = 16;

/// Shape of a track: bent by the field or not.
enum class track_shape { helix, line };

/// Space points that belong together, at most one a station, and the track that pattern recognition saw in them.
struct candidate {
  int tracker = 0;
  track_shape shape = track_shape::helix;
  inline_vector<int, max_stations> space_points;  ///< indices, in order of growing z
  /// (x, tx, y, ty, q/pz) as slope_state at `z`, with its covariance; for a line q/pz is that of the assumed momentum.
  kalman::estimate<double, 5> seed;
  double z = 0.0;  ///< of the seed, tracker frame, mm
  double chi2 = 0.0;
  int ndf = 0;
};

}  // namespace scifi
