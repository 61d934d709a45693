// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

namespace scifi::test {

/// Number with derivatives in two variables.
using dual = Eigen::AutoDiffScalar<Eigen::Vector2d>;

/// The k-th variable (0 or 1).
inline dual variable(double value, int k) { return dual(value, 2, k); }

/// A number that depends on nothing.
inline dual constant(double value) { return dual(value, Eigen::Vector2d::Zero()); }

}  // namespace scifi::test
