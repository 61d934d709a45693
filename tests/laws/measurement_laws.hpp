// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/kalman/measurement.hpp>

namespace laws {

/// Largest difference between a measurement's Jacobian and central differences of its residual with steps h times `units`.
template <class Z, class Scalar, int N>
Scalar measurement_jacobian_deviation(const Z& m, const scifi::vector<Scalar, N>& x, Scalar h,
                                      const scifi::vector<Scalar, N>& units = scifi::vector<Scalar, N>::Ones()) {
  const auto at = scifi::kalman::compare(m, x);
  Scalar worst = 0;
  for (int j = 0; j < N; ++j) {
    scifi::vector<Scalar, N> up = x, down = x;
    up(j) += h * units(j);
    down(j) -= h * units(j);
    const auto slope = ((scifi::kalman::compare(m, down).residual - scifi::kalman::compare(m, up).residual) / (2 * h)).eval();
    const Scalar off = (slope - at.jacobian.col(j) * units(j)).cwiseAbs().maxCoeff();
    worst = off < worst ? worst : off;
  }
  return worst;
}

}  // namespace laws
