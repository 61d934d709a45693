// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/kalman/node.hpp>
#include <scifi/kalman/residual.hpp>

namespace scifi::kalman {

/// The residual of a node, of up to MaxM dimensions; empty where nothing was measured.
template <class Scalar, int MaxM>
using node_residual = residual<Scalar, Eigen::Dynamic, MaxM>;

namespace detail {

/// Residual at the estimate e, from the predicted one through the node's H; covariance R + sign H P H'.
template <class Scalar, int N, int MaxM>
[[nodiscard]] node_residual<Scalar, MaxM> residual_at(const node<Scalar, N, MaxM>& n, const estimate<Scalar, N>& e, double sign) {
  const vector<Scalar, N> moved = e.mean - n.predicted.mean;
  const bounded_matrix<Scalar, Eigen::Dynamic, N, MaxM, N> hp = n.projection.lazyProduct(e.covariance);
  node_residual<Scalar, MaxM> out{n.residual, n.measurement_covariance};
  out.value.noalias() -= n.projection.lazyProduct(moved);
  out.covariance.noalias() += Scalar(sign) * hp.lazyProduct(n.projection.transpose());
  return out;
}

}  // namespace detail

/// Seen from the estimate before this site's measurement: covariance S = R + H P H'.
template <class Scalar, int N, int MaxM>
[[nodiscard]] node_residual<Scalar, MaxM> predicted_residual(const node<Scalar, N, MaxM>& n) {
  return {n.residual, n.residual_covariance};
}

/// Seen from the estimate after this site's measurement: covariance R - H P H', or S for an outlier, which was not used.
template <class Scalar, int N, int MaxM>
[[nodiscard]] node_residual<Scalar, MaxM> filtered_residual(const node<Scalar, N, MaxM>& n) {
  return detail::residual_at(n, n.filtered, n.outlier ? 1.0 : -1.0);
}

/// Seen from the smoothed estimate: covariance R - H P H', or R + H P H' for an outlier, which was not used.
template <class Scalar, int N, int MaxM>
[[nodiscard]] node_residual<Scalar, MaxM> smoothed_residual(const node<Scalar, N, MaxM>& n) {
  return detail::residual_at(n, n.smoothed, n.outlier ? 1.0 : -1.0);
}

/// Seen from the smoothed estimate with this measurement removed: not biased towards it. NaN where the others do not fix the state.
template <class Scalar, int N, int MaxM>
[[nodiscard]] node_residual<Scalar, MaxM> unbiased_residual(const node<Scalar, N, MaxM>& n) {
  const node_residual<Scalar, MaxM> seen = smoothed_residual(n);
  if (n.outlier) return seen;
  return without_own_measurement(seen, n.measurement_covariance);
}

}  // namespace scifi::kalman
