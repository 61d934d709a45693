// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/one_alignment.hpp>

#include <Eigen/Core>

namespace scifi {

/// Column vector of N numbers, on the stack.
template <class Scalar, int N>
using vector = Eigen::Matrix<Scalar, N, 1>;

/// Matrix of Rows x Cols numbers, on the stack.
template <class Scalar, int Rows, int Cols>
using matrix = Eigen::Matrix<Scalar, Rows, Cols>;

/// Average of a matrix and its transpose; with the lower triangle copied from the upper one the result is symmetric to the last bit.
template <class Scalar, int N>
[[nodiscard]] matrix<Scalar, N, N> symmetrised(const matrix<Scalar, N, N>& m) {
  matrix<Scalar, N, N> out;
  for (int i = 0; i < N; ++i) {
    out(i, i) = m(i, i);
    for (int j = i + 1; j < N; ++j) out(i, j) = out(j, i) = Scalar(0.5) * (m(i, j) + m(j, i));
  }
  return out;
}

}  // namespace scifi
