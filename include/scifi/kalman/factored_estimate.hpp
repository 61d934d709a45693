// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/linalg.hpp>
#include <scifi/kalman/cholesky.hpp>
#include <scifi/kalman/estimate.hpp>
#include <scifi/kalman/symmetric.hpp>

namespace scifi::kalman {

/// An estimate that keeps a lower triangular factor L of its covariance P = L L', so that P cannot lose symmetry or definiteness.
template <class Scalar, int N>
struct factored_estimate {
  static_assert(N > 0, "scifi: an estimate needs a fixed-size Eigen mean and covariance; a dynamic size is not accepted");
  using scalar = Scalar;
  static constexpr int dimension = N;

  vector<Scalar, N> mean;
  matrix<Scalar, N, N> factor;

  /// P = L L', N x N, symmetric to the last bit.
  [[nodiscard]] matrix<Scalar, N, N> covariance() const {
    return detail::symmetric_sum<Scalar, N, N>(matrix<Scalar, N, N>::Zero(), factor, factor);
  }
};

/// Factors the covariance of an estimate; it must be positive semidefinite.
template <class Scalar, int N>
[[nodiscard]] factored_estimate<Scalar, N> factored(const estimate<Scalar, N>& e) {
  return {e.mean, semidefinite_factor<Scalar, N>(e.covariance)};
}

/// The same knowledge as mean and covariance.
template <class Scalar, int N>
[[nodiscard]] estimate<Scalar, N> unfactored(const factored_estimate<Scalar, N>& e) {
  return {e.mean, e.covariance()};
}

/// An estimate as it is.
template <class Scalar, int N>
[[nodiscard]] const estimate<Scalar, N>& unfactored(const estimate<Scalar, N>& e) {
  return e;
}

}  // namespace scifi::kalman
