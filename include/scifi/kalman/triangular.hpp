// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/core/linalg.hpp>
#include <scifi/core/scalar.hpp>

namespace scifi::kalman {

/// Lower triangular L (Rows x Rows, diagonal not negative) with L L' = A A', without forming A A'.
///
/// Householder reflections from the right (Golub and Van Loan, Matrix Computations, 4th ed., section 5.1 and 5.2), so the condition
/// number that matters is that of A, not its square. Cols >= Rows. No data-dependent branches. What is not finite in A leaves NaN or infinity on the diagonal.
template <class Scalar, int Rows, int Cols>
[[nodiscard]] matrix<Scalar, Rows, Rows> lower_triangular(matrix<Scalar, Rows, Cols> a) {
  static_assert(Cols >= Rows, "scifi: lower_triangular needs at least as many columns as rows");
  using std::sqrt;
  matrix<Scalar, Rows, Rows> lower = matrix<Scalar, Rows, Rows>::Zero();
  for (int k = 0; k < Rows; ++k) {
    Scalar norm2(0.0);
    for (int j = k; j < Cols; ++j) norm2 += a(k, j) * a(k, j);
    const auto nonzero = norm2 > Scalar(0.0);
    const Scalar root = sqrt(select(nonzero, norm2, Scalar(1.0)));
    const Scalar norm = select(nonzero, root, norm2);  // zero, or NaN
    // v = row - alpha e_k with alpha of the sign opposite to the leading entry, so that nothing cancels.
    const Scalar lead(a(k, k));
    const Scalar alpha = select(lead < Scalar(0.0), norm, Scalar(-norm));
    const Scalar v_k = lead - alpha;
    // v'v / 2 = norm (norm + |lead|) = -alpha v_k.
    const Scalar half_vv = -alpha * v_k;
    const Scalar beta = Scalar(1.0) / select(nonzero, half_vv, Scalar(1.0));
    // Row k becomes alpha e_k; flipping the column's sign makes the diagonal not negative.
    const Scalar flip = select(alpha < Scalar(0.0), Scalar(-1.0), Scalar(1.0));
    lower(k, k) = norm;
    for (int i = k + 1; i < Rows; ++i) {
      Scalar dot = a(i, k) * v_k;
      for (int j = k + 1; j < Cols; ++j) dot += a(i, j) * a(k, j);
      const Scalar scale = select(nonzero, Scalar(dot * beta), Scalar(0.0));
      lower(i, k) = flip * (a(i, k) - scale * v_k);
      for (int j = k + 1; j < Cols; ++j) a(i, j) -= scale * a(k, j);
    }
  }
  return lower;
}

}  // namespace scifi::kalman
