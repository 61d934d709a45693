// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/linalg.hpp>
#include <scifi/kalman/node.hpp>

namespace scifi::kalman::detail {

/// The measurement of a node in matrices of fixed size.
template <class Scalar, int N, int M>
struct measured_view {
  static constexpr int size = M;
  vector<Scalar, M> residual;
  matrix<Scalar, M, M> residual_covariance;
  matrix<Scalar, M, N> jacobian;
  matrix<Scalar, M, M> measurement_covariance;
  mask<Scalar> outlier;
};

/// A bounded matrix whose present size is known to be Rows x Cols, as one of fixed size.
template <int Rows, int Cols, class Bounded>
[[nodiscard]] auto as_fixed(const Bounded& a) {
  using fixed = matrix<typename Bounded::Scalar, Rows, Cols>;
  return fixed(Eigen::Map<const fixed>(a.data()));
}

/// Calls f with the node's measurement as a `measured_view` of its dimension; not where nothing was measured.
template <int M = 1, class Scalar, int N, int MaxM, class F>
void with_measurement(const node<Scalar, N, MaxM>& n, const F& f) {
  if (n.measurement_dimension == M) {
    f(measured_view<Scalar, N, M>{as_fixed<M, 1>(n.residual), as_fixed<M, M>(n.residual_covariance), as_fixed<M, N>(n.projection),
                                  as_fixed<M, M>(n.measurement_covariance), n.outlier});
  } else if constexpr (M < MaxM) {
    with_measurement<M + 1>(n, f);
  }
}

/// bounded = a, of any size.
template <class Bounded, class A>
void assign_bounded(Bounded& bounded, const A& a) {
  constexpr int size = A::SizeAtCompileTime;
  if constexpr (size > 0) {
    bounded.resize(a.rows(), a.cols());
    for (int i = 0; i < size; ++i) bounded.data()[i] = a.data()[i];
  } else {
    bounded = a;
  }
}

}  // namespace scifi::kalman::detail
