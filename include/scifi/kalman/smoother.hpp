// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <iterator>
#include <span>
#include <type_traits>

#include <scifi/kalman/cholesky.hpp>
#include <scifi/kalman/node.hpp>
#include <scifi/kalman/symmetric.hpp>

namespace scifi::kalman {

/// Smooths the node before another: gain G = P_f F' P_p^-1, with P_f filtered here and F, P_p, Q of the node after.
///
/// Mean x_f + G (x_s - x_p); covariance (I - G F) P_f (I - G F)' + G (Q + P_s) G', which equals P_f + G (P_s - P_p) G' of the source
/// but adds positive terms only. Rauch, Tung, Striebel 1965, AIAA J. 3, 1445, eq. 3.28-3.30.
template <class Scalar, int N, int MaxM>
[[nodiscard]] status smooth_one(node<Scalar, N, MaxM>& here, const node<Scalar, N, MaxM>& after) {
  const cholesky<Scalar, N> factor(after.predicted.covariance);
  if (!any_of(factor.ok())) return {step_kind::smooth, reason::not_positive_definite};
  const matrix<Scalar, N, N> moved = after.jacobian.lazyProduct(here.filtered.covariance);
  const matrix<Scalar, N, N> gain = detail::transposed<Scalar, N, N>(factor.template solve<N>(moved));
  const vector<Scalar, N> change = after.smoothed.mean - after.predicted.mean;
  matrix<Scalar, N, N> rest = matrix<Scalar, N, N>::Identity();
  rest.noalias() -= gain.lazyProduct(after.jacobian);
  const matrix<Scalar, N, N> kept = detail::similarity<Scalar, N, N>(rest, here.filtered.covariance);
  const matrix<Scalar, N, N> outside = after.noise + after.smoothed.covariance;
  here.smoothed.mean = here.filtered.mean + gain.lazyProduct(change);
  here.smoothed.covariance = detail::similarity<Scalar, N, N>(gain, outside, kept);
  return {step_kind::smooth, fault_of(here.smoothed.mean, here.smoothed.covariance)};
}

/// Smooths the nodes of a run, last to first: afterwards `smoothed` of every node knows all measurements.
///
/// Pass the nodes that were reached. On failure the node it happened at holds the status; those before it are not smoothed.
template <class Scalar, int N, int MaxM>
[[nodiscard]] status smooth(std::span<node<Scalar, N, MaxM>> nodes) {
  if (nodes.empty()) return {step_kind::smooth, reason::none};
  if (!nodes.back().status.ok()) return nodes.back().status;
  nodes.back().smoothed = nodes.back().filtered;
  for (std::size_t k = nodes.size() - 1; k-- > 0;) {
    if (!nodes[k].status.ok()) return nodes[k].status;
    const status s = smooth_one(nodes[k], nodes[k + 1]);
    if (!s.ok()) {
      nodes[k].status = s;
      return s;
    }
  }
  return {step_kind::smooth, reason::none};
}

/// The same for any contiguous range of nodes.
template <class Nodes>
[[nodiscard]] status smooth(Nodes& nodes) {
  return smooth(std::span<std::remove_reference_t<decltype(*std::data(nodes))>>(nodes));
}

}  // namespace scifi::kalman
