// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/core/linalg.hpp>
#include <scifi/core/scalar.hpp>

namespace scifi::kalman {

/// Cholesky factorisation A = L L' of a small symmetric matrix, without data-dependent branches.
///
/// Golub and Van Loan, Matrix Computations, 4th ed., algorithm 4.2.1. `ok` is false (in every lane that fails) where a pivot is not
/// above N eps A_ii: A is then singular to working precision, indefinite or not finite, and the solutions mean nothing.
template <class Scalar, int N>
class cholesky {
 public:
  explicit cholesky(const matrix<Scalar, N, N>& a) {
    using std::sqrt;
    const Scalar threshold = Scalar(static_cast<double>(N) * static_cast<double>(Eigen::NumTraits<Scalar>::epsilon()));
    Scalar margin(1.0);
    for (int j = 0; j < N; ++j) {
      Scalar pivot(a(j, j));
      for (int k = 0; k < j; ++k) pivot -= lower_(j, k) * lower_(j, k);
      const Scalar above = pivot - threshold * a(j, j);
      margin = select(above > Scalar(0.0), margin, Scalar(-1.0));
      const Scalar safe = select(pivot > Scalar(0.0), pivot, Scalar(1.0));
      lower_(j, j) = sqrt(safe);
      inverse_diagonal_(j) = Scalar(1.0) / lower_(j, j);
      for (int i = j + 1; i < N; ++i) {
        Scalar sum(a(i, j));
        for (int k = 0; k < j; ++k) sum -= lower_(i, k) * lower_(j, k);
        lower_(i, j) = sum * inverse_diagonal_(j);
        lower_(j, i) = Scalar(0.0);
      }
    }
    margin_ = margin;
  }

  /// True where the matrix was positive definite to working precision.
  [[nodiscard]] auto ok() const { return margin_ > Scalar(0.0); }

  /// The factor L, lower triangular.
  [[nodiscard]] const matrix<Scalar, N, N>& lower() const { return lower_; }

  /// L^-1 b.
  template <int K>
  [[nodiscard]] matrix<Scalar, N, K> half_solve(const matrix<Scalar, N, K>& b) const {
    matrix<Scalar, N, K> y;
    for (int c = 0; c < K; ++c) {
      for (int i = 0; i < N; ++i) {
        Scalar sum(b(i, c));
        for (int k = 0; k < i; ++k) sum -= lower_(i, k) * y(k, c);
        y(i, c) = sum * inverse_diagonal_(i);
      }
    }
    return y;
  }

  /// A^-1 b.
  template <int K>
  [[nodiscard]] matrix<Scalar, N, K> solve(const matrix<Scalar, N, K>& b) const {
    matrix<Scalar, N, K> y = half_solve<K>(b);
    for (int c = 0; c < K; ++c) {
      for (int i = N - 1; i >= 0; --i) {
        Scalar sum(y(i, c));
        for (int k = i + 1; k < N; ++k) sum -= lower_(k, i) * y(k, c);
        y(i, c) = sum * inverse_diagonal_(i);
      }
    }
    return y;
  }

 private:
  matrix<Scalar, N, N> lower_;
  vector<Scalar, N> inverse_diagonal_;
  Scalar margin_;
};

/// Lower factor L of a symmetric positive semidefinite matrix, L L' = A; a pivot below N eps A_ii gives a column of zeros, one that is not finite NaN.
/// A process noise is often of lower rank than the state, which `cholesky` would refuse.
template <class Scalar, int N>
[[nodiscard]] matrix<Scalar, N, N> semidefinite_factor(const matrix<Scalar, N, N>& a) {
  using std::sqrt;
  const Scalar threshold = Scalar(static_cast<double>(N) * static_cast<double>(Eigen::NumTraits<Scalar>::epsilon()));
  matrix<Scalar, N, N> lower = matrix<Scalar, N, N>::Zero();
  for (int j = 0; j < N; ++j) {
    Scalar pivot(a(j, j));
    for (int k = 0; k < j; ++k) pivot -= lower(j, k) * lower(j, k);
    const Scalar least = threshold * a(j, j);
    const auto positive = pivot > least;
    const Scalar root = sqrt(select(positive, pivot, Scalar(1.0)));
    const Scalar inverse = Scalar(1.0) / root;
    lower(j, j) = select(positive, root, Scalar(pivot - pivot));  // zero, or NaN
    for (int i = j + 1; i < N; ++i) {
      Scalar sum(a(i, j));
      for (int k = 0; k < j; ++k) sum -= lower(i, k) * lower(j, k);
      const Scalar entry = sum * inverse;
      lower(i, j) = select(positive, entry, Scalar(0.0));
    }
  }
  return lower;
}

}  // namespace scifi::kalman
