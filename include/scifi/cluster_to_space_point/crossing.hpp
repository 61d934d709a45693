// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include <scifi/core/linalg.hpp>
#include <scifi/event/cluster.hpp>
#include <scifi/geometry/station.hpp>

namespace scifi {

/// Where the lines of several clusters of one station meet, least squares.
struct crossing_point {
  vector<double, 2> position = vector<double, 2>::Zero();             ///< x, y, tracker frame, mm
  matrix<double, 2, 2> covariance = matrix<double, 2, 2>::Identity(); ///< mm^2
  double z = 0.0;                                                      ///< mean z of the planes, tracker frame, mm
  double chi2 = 0.0;                                                   ///< number of clusters - 2 degrees of freedom
  bool defined = false;                                                ///< false for parallel lines, and where a variance is zero or NaN
};

/// Crossing of one cluster per entry of `chosen`, for the actual orientation of the planes.
///
/// Each cluster measures n . (x, y) = alpha + offset with its variance; the planes are at different z while the slope is not known yet, which
/// adds (slope_spread (z - mean z))^2 to each variance. The normal equations are 2 x 2.
[[nodiscard]] inline crossing_point cross(const station& where, std::span<const cluster* const> chosen, double slope_spread) {
  crossing_point out;
  for (const cluster* c : chosen) out.z += where.planes[static_cast<std::size_t>(c->plane)].z_measured;
  out.z /= static_cast<double>(chosen.size());
  matrix<double, 2, 2> information = matrix<double, 2, 2>::Zero();
  vector<double, 2> sum = vector<double, 2>::Zero();
  double squares = 0.0;
  for (const cluster* c : chosen) {
    const plane& p = where.planes[static_cast<std::size_t>(c->plane)];
    const vector<double, 2> n{std::cos(p.angle), std::sin(p.angle)};
    const double lever = slope_spread * (p.z_measured - out.z);
    const double weight = 1.0 / (c->variance + lever * lever);
    information += weight * n * n.transpose();
    sum += weight * c->alpha * n;
    squares += weight * c->alpha * c->alpha;
  }
  const double determinant = information(0, 0) * information(1, 1) - information(0, 1) * information(1, 0);
  const double trace = information(0, 0) + information(1, 1);
  out.defined = determinant > 1e-9 * trace * trace;
  if (!out.defined) return out;
  matrix<double, 2, 2> covariance;
  covariance << information(1, 1), -information(0, 1), -information(1, 0), information(0, 0);
  covariance /= determinant;
  const vector<double, 2> in_station = covariance * sum;
  out.chi2 = squares - in_station.dot(sum);

  const placement& at = where.in_tracker;
  const vector<double, 3> in_tracker = at.child_to_parent({in_station.x(), in_station.y(), out.z});
  out.position = in_tracker.head<2>();
  out.z = in_tracker.z();
  const double c = std::cos(at.angle);
  const double s = std::sin(at.angle);
  matrix<double, 2, 2> to_tracker;
  to_tracker << c, -s, s, c;
  out.covariance = to_tracker * covariance * to_tracker.transpose();
  return out;
}

}  // namespace scifi
