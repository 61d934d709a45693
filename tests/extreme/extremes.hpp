// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cmath>
#include <limits>

namespace scifi::test {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Numbers that nobody means and that arrive all the same.
inline constexpr std::array extremes{0.0,  -0.0,     1e-320, 1e-300, -1e-300,   1e-160,    -1.0, 1e16,
                                     1e160, -1e160, 1e300,  -1e300, std::numeric_limits<double>::max(), infinity, -infinity, not_a_number};

/// True where a matrix holds finite numbers only.
template <class Matrix>
[[nodiscard]] bool all_finite(const Matrix& m) {
  for (int j = 0; j < m.cols(); ++j)
    for (int i = 0; i < m.rows(); ++i)
      if (!std::isfinite(m(i, j))) return false;
  return true;
}

/// True for an estimate of finite numbers whose variances are not negative.
template <class Estimate>
[[nodiscard]] bool sound(const Estimate& e) {
  return all_finite(e.mean) && all_finite(e.covariance) && (e.covariance.diagonal().array() >= 0.0).all();
}

}  // namespace scifi::test
