// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/core/linalg.hpp>

namespace scifi {

/// Where a child frame sits in its parent frame, and the two ways between them. The one place where the sign of a rotation is decided.
///
/// Rotations are passive and about z: the child's axes are the parent's turned by `angle` (rad, counter-clockwise seen against +z), so
///   child = R (parent - origin),  R = [[cos, sin, 0], [-sin, cos, 0], [0, 0, 1]].
/// Frames of the library, outermost first: tracker (mm, z from station 1 to the last station), station, plane (alpha, beta, z).
struct placement {
  vector<double, 3> origin = vector<double, 3>::Zero();  ///< origin of the child in the parent frame, mm
  double angle = 0.0;                                    ///< rad

  /// A point given in the parent frame, in the child frame (mm).
  [[nodiscard]] vector<double, 3> parent_to_child(const vector<double, 3>& point) const { return turn(point - origin, angle); }
  /// A point given in the child frame, in the parent frame (mm).
  [[nodiscard]] vector<double, 3> child_to_parent(const vector<double, 3>& point) const { return turn(point, -angle) + origin; }
  /// A direction given in the parent frame, in the child frame.
  [[nodiscard]] vector<double, 3> direction_parent_to_child(const vector<double, 3>& v) const { return turn(v, angle); }
  /// A direction given in the child frame, in the parent frame.
  [[nodiscard]] vector<double, 3> direction_child_to_parent(const vector<double, 3>& v) const { return turn(v, -angle); }

 private:
  [[nodiscard]] static vector<double, 3> turn(const vector<double, 3>& v, double by) {
    const double c = std::cos(by);
    const double s = std::sin(by);
    return {c * v.x() + s * v.y(), -s * v.x() + c * v.y(), v.z()};
  }
};

}  // namespace scifi
