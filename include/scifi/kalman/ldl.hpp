// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/linalg.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/kalman/each_index.hpp>
#include <scifi/kalman/product.hpp>

namespace scifi::kalman {

/// Factorisation A = L D L' of a small symmetric matrix, L with a diagonal of ones, D diagonal: no square roots, no data-dependent branches.
///
/// Golub and Van Loan, Matrix Computations, 4th ed., section 4.1.2. `ok` is false (in every lane that fails) where a pivot is not above
/// N eps A_ii: A is then singular to working precision, indefinite or not finite, and the solutions mean nothing.
template <class Scalar, int N>
class ldl {
 public:
  /// Of nothing yet.
  ldl() = default;
  /// Reads the lower triangle.
  explicit ldl(const matrix<Scalar, N, N>& a) { factorise(a); }

  /// Factorises in place: a factorisation copied right after it was made would hold up the processor.
  [[gnu::always_inline]] void factorise(const matrix<Scalar, N, N>& a) {
    const Scalar threshold = Scalar(static_cast<double>(N) * static_cast<double>(Eigen::NumTraits<Scalar>::epsilon()));
    margin_ = Scalar(1.0);
    matrix<Scalar, N, N> scaled;  // L D
    detail::each_index<N>([&](int j) __attribute__((always_inline)) {
      Scalar pivot(a(j, j));
      for (int k = 0; k < j; ++k) pivot -= scaled(j, k) * lower_(j, k);
      const Scalar above = pivot - threshold * a(j, j);
      margin_ = select(above > Scalar(0.0), margin_, Scalar(-1.0));
      const Scalar safe = select(pivot > Scalar(0.0), pivot, Scalar(1.0));
      inverse_(j) = Scalar(1.0) / safe;
      for (int i = j + 1; i < N; ++i) {
        Scalar sum(a(i, j));
        for (int k = 0; k < j; ++k) sum -= scaled(i, k) * lower_(j, k);
        scaled(i, j) = sum;
        lower_(i, j) = sum * inverse_(j);
      }
    });
  }

  /// True where the matrix was positive definite to working precision.
  [[nodiscard]] auto ok() const { return margin_ > Scalar(0.0); }

  /// 1 / D.
  [[nodiscard]] const vector<Scalar, N>& inverse_diagonal() const { return inverse_; }

  /// b = b L'^-1 (Rows x N): with columns z_k of the result, b A^-1 b' is the sum of z_k z_k' / D_k.
  template <int Rows>
  [[gnu::always_inline]] void decorrelate(matrix<Scalar, Rows, N>& b) const {
    detail::each_index<N>([&](int j) __attribute__((always_inline)) {
      for (int k = 0; k < j; ++k) detail::subtract_column<Scalar, Rows, N>(b, k, j, lower_(j, k));
    });
  }

  /// b = z D^-1 L^-1 (Rows x N): with decorrelate before it, b A^-1.
  template <int Rows>
  [[gnu::always_inline]] void recombine(matrix<Scalar, Rows, N>& b, const matrix<Scalar, Rows, N>& z) const {
    detail::each_index<N>([&](int up) __attribute__((always_inline)) {
      const int j = N - 1 - up;
      detail::set_scaled_column<Scalar, Rows, N>(b, z, j, inverse_(j));
      for (int i = j + 1; i < N; ++i) detail::subtract_column<Scalar, Rows, N>(b, i, j, lower_(i, j));
    });
  }

  /// b A^-1, Rows x N.
  template <int Rows>
  [[nodiscard]] matrix<Scalar, Rows, N> solve_from_right(matrix<Scalar, Rows, N> b) const {
    decorrelate<Rows>(b);
    recombine<Rows>(b, b);
    return b;
  }

  /// y = L^-1 v: v' A^-1 v is the sum of y_k^2 / D_k.
  [[nodiscard]] vector<Scalar, N> half_solve(const vector<Scalar, N>& v) const {
    vector<Scalar, N> y;
    detail::each_index<N>([&](int i) __attribute__((always_inline)) {
      Scalar rest(v(i));
      for (int k = 0; k < i; ++k) rest -= lower_(i, k) * y(k);
      y(i) = rest;
    });
    return y;
  }

 private:
  matrix<Scalar, N, N> lower_;  // below the diagonal only
  vector<Scalar, N> inverse_;   // of D
  Scalar margin_;
};

}  // namespace scifi::kalman
