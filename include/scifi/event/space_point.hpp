// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/inline_vector.hpp>
#include <scifi/core/linalg.hpp>

namespace scifi {

/// Planes of a station that a space point can join.
inline constexpr int max_planes_per_station = 4;

/// A point in space where the fibres of two or more clusters of a station cross.
struct space_point {
  int tracker = 0;
  int station = 1;
  vector<double, 2> position = vector<double, 2>::Zero();            ///< x, y, tracker frame, mm
  double z = 0.0;                                                     ///< tracker frame, mm
  matrix<double, 2, 2> covariance = matrix<double, 2, 2>::Identity(); ///< of x, y, mm^2
  double chi2 = 0.0;                                                  ///< of the crossing; one degree of freedom for a triplet, none for a doublet
  double npe = 0.0;                                                   ///< sum over its clusters, photo-electrons
  inline_vector<int, max_planes_per_station> clusters;                ///< indices of its clusters, in order of the planes
};

}  // namespace scifi
