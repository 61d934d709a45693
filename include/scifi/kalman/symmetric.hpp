// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/linalg.hpp>

namespace scifi::kalman::detail {

/// The transpose as a matrix of its own (g++ 12 takes Eigen's check for aliasing in the constructor for a use before initialisation).
template <class Scalar, int Rows, int Cols>
[[nodiscard]] matrix<Scalar, Cols, Rows> transposed(const matrix<Scalar, Rows, Cols>& a) {
  matrix<Scalar, Cols, Rows> out;
  for (int j = 0; j < Cols; ++j)
    for (int i = 0; i < Rows; ++i) out(j, i) = a(i, j);
  return out;
}

/// base + a b', where the result is known to be symmetric: the upper triangle is computed and copied, so it is symmetric to the last bit.
template <class Scalar, int N, int K>
[[nodiscard]] matrix<Scalar, N, N> symmetric_sum(const matrix<Scalar, N, N>& base, const matrix<Scalar, N, K>& a, const matrix<Scalar, N, K>& b) {
  matrix<Scalar, N, N> out;
  for (int j = 0; j < N; ++j) {
    for (int i = 0; i <= j; ++i) {
      Scalar sum(base(i, j));
      for (int k = 0; k < K; ++k) sum += a(i, k) * b(j, k);
      out(i, j) = sum;
      out(j, i) = sum;
    }
  }
  return out;
}

/// f p f' + added, with p and `added` symmetric; symmetric to the last bit.
template <class Scalar, int N, int K>
[[nodiscard]] matrix<Scalar, N, N> similarity(const matrix<Scalar, N, K>& f, const matrix<Scalar, K, K>& p, const matrix<Scalar, N, N>& added) {
  matrix<Scalar, N, K> fp;
  fp.noalias() = f.lazyProduct(p);
  return symmetric_sum<Scalar, N, K>(added, fp, f);
}

/// f p f', symmetric to the last bit.
template <class Scalar, int N, int K>
[[nodiscard]] matrix<Scalar, N, N> similarity(const matrix<Scalar, N, K>& f, const matrix<Scalar, K, K>& p) {
  return similarity<Scalar, N, K>(f, p, matrix<Scalar, N, N>::Zero());
}

}  // namespace scifi::kalman::detail
