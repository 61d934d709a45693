// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/kalman/node.hpp>
#include <scifi/kalman/node_view.hpp>
#include <scifi/kalman/product.hpp>
#include <scifi/kalman/residual.hpp>

namespace scifi::kalman {

/// The residual of a node, of up to MaxM dimensions; empty where nothing was measured.
template <class Scalar, int MaxM>
using node_residual = residual<Scalar, Eigen::Dynamic, MaxM>;

namespace detail {

/// Residual at the estimate e, from the predicted one through the node's H; covariance R + sign H P H'.
template <class Scalar, int N, int M>
[[nodiscard]] residual<Scalar, M> residual_at(const measured_view<Scalar, N, M>& seen, const vector<Scalar, N>& predicted, const estimate<Scalar, N>& e, const Scalar& sign) {
  const vector<Scalar, N> moved = e.mean - predicted;
  const matrix<Scalar, N, M> cross = times_transposed<Scalar, N, N, M>(e.covariance, seen.jacobian);
  return {seen.residual - times_vector<Scalar, M, N>(seen.jacobian, moved), seen.measurement_covariance + sign * times<Scalar, M, N, M>(seen.jacobian, cross)};
}

/// The sign with which H P H' enters: a measurement that was used shares its error with the estimate.
template <class Scalar, int N, int MaxM>
[[nodiscard]] Scalar sign_of(const node<Scalar, N, MaxM>& n) {
  return select(n.outlier, Scalar(1.0), Scalar(-1.0));
}

/// Calls f with the node's measurement, if there is one, for a residual of its dimension, and returns that as one of any dimension.
template <class Scalar, int N, int MaxM, class F>
[[nodiscard]] node_residual<Scalar, MaxM> residual_of(const node<Scalar, N, MaxM>& n, const F& f) {
  node_residual<Scalar, MaxM> out;
  with_measurement(n, [&](const auto& seen) {
    const auto r = f(seen);
    assign_bounded(out.value, r.value);
    assign_bounded(out.covariance, r.covariance);
  });
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
  return detail::residual_of(n, [&n](const auto& seen) { return detail::residual_at(seen, n.predicted.mean, n.filtered, detail::sign_of(n)); });
}

/// Seen from the smoothed estimate: covariance R - H P H', or R + H P H' for an outlier, which was not used.
template <class Scalar, int N, int MaxM>
[[nodiscard]] node_residual<Scalar, MaxM> smoothed_residual(const node<Scalar, N, MaxM>& n) {
  return detail::residual_of(n, [&n](const auto& seen) { return detail::residual_at(seen, n.predicted.mean, n.smoothed, detail::sign_of(n)); });
}

/// Seen from the smoothed estimate with this measurement removed: not biased towards it. NaN where the others do not fix the state.
template <class Scalar, int N, int MaxM>
[[nodiscard]] node_residual<Scalar, MaxM> unbiased_residual(const node<Scalar, N, MaxM>& n) {
  return detail::residual_of(n, [&n](const auto& seen) {
    auto r = detail::residual_at(seen, n.predicted.mean, n.smoothed, detail::sign_of(n));
    const auto unbiased = without_own_measurement(r, seen.measurement_covariance);
    for (int i = 0; i < r.value.size(); ++i) r.value(i) = select(n.outlier, Scalar(r.value(i)), Scalar(unbiased.value(i)));
    for (int i = 0; i < r.covariance.size(); ++i) r.covariance.data()[i] = select(n.outlier, Scalar(r.covariance.data()[i]), Scalar(unbiased.covariance.data()[i]));
    return r;
  });
}

}  // namespace scifi::kalman
