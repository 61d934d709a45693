// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <iterator>
#include <span>
#include <type_traits>

#include <scifi/kalman/ldl.hpp>
#include <scifi/kalman/node.hpp>
#include <scifi/kalman/symmetric.hpp>

namespace scifi::kalman {

/// Smooths the node before another: gain G = P_f F' P_p^-1, with P_f filtered here and F, P_p, Q of the node after.
///
/// Mean x_f + G (x_s - x_p); covariance (I - G F) P_f (I - G F)' + G (Q + P_s) G', which equals P_f + G (P_s - P_p) G' of the source
/// but adds positive terms only. Rauch, Tung, Striebel 1965, AIAA J. 3, 1445, eq. 3.28-3.30.
template <class Scalar, int N, int MaxM>
[[nodiscard]] status smooth_one(node<Scalar, N, MaxM>& here, const node<Scalar, N, MaxM>& after) {
  const ldl<Scalar, N> factor(after.predicted.covariance);
  if (!any_of(factor.ok())) return {step_kind::smooth, reason::not_positive_definite};
  matrix<Scalar, N, N> gain = detail::times_transposed<Scalar, N, N, N>(here.filtered.covariance, after.jacobian);
  factor.template decorrelate<N>(gain);
  factor.template recombine<N>(gain, gain);
  const vector<Scalar, N> change = after.smoothed.mean - after.predicted.mean;
  matrix<Scalar, N, N> rest = matrix<Scalar, N, N>::Identity();
  rest -= detail::times<Scalar, N, N, N>(gain, after.jacobian);
  const matrix<Scalar, N, N> kept = detail::similarity<Scalar, N, N>(rest, here.filtered.covariance);
  const matrix<Scalar, N, N> outside = after.noise + after.smoothed.covariance;
  here.smoothed.mean = here.filtered.mean + detail::times_vector<Scalar, N, N>(gain, change);
  detail::set_similarity<Scalar, N, N>(here.smoothed.covariance, gain, outside, kept);
  return {step_kind::smooth, fault_of(here.smoothed.mean, here.smoothed.covariance)};
}

/// The Rauch-Tung-Striebel smoother, in a form that keeps covariances positive however much smoothing shrinks them.
struct rauch_tung_striebel {
  /// Sets `smoothed` of all nodes. `start`, where given, is replaced by the smoothed estimate at the start of the first step.
  template <class Scalar, int N, int MaxM>
  [[nodiscard]] status operator()(std::span<node<Scalar, N, MaxM>> nodes, estimate<Scalar, N>* start = nullptr) const {
    constexpr status fine{step_kind::smooth, reason::none};
    if (nodes.empty()) return fine;
    if (!nodes.back().status.ok()) return nodes.back().status;
    nodes.back().smoothed = nodes.back().filtered;
    for (std::size_t k = nodes.size() - 1; k-- > 0;) {
      if (!nodes[k].status.ok()) return nodes[k].status;
      const status s = smooth_one(nodes[k], nodes[k + 1]);
      if (!s.ok()) return nodes[k].status = s;
    }
    if (start == nullptr) return fine;
    node<Scalar, N, MaxM> begin;
    begin.filtered = *start;
    const status s = smooth_one(begin, nodes[0]);
    if (s.ok()) *start = begin.smoothed;
    return s;
  }
};

/// Smooths the nodes of a run, last to first: afterwards `smoothed` of every node knows all measurements.
///
/// Pass the nodes that were reached. On failure the node it happened at holds the status; those before it are not smoothed.
template <class Scalar, int N, int MaxM, class Smoother = rauch_tung_striebel>
[[nodiscard]] status smooth(std::span<node<Scalar, N, MaxM>> nodes, const Smoother& smoother = {}) {
  return smoother(nodes);
}

/// The same for any contiguous range of nodes.
template <class Nodes, class Smoother = rauch_tung_striebel>
[[nodiscard]] status smooth(Nodes& nodes, const Smoother& smoother = {}) {
  return smoother(std::span<std::remove_reference_t<decltype(*std::data(nodes))>>(nodes));
}

}  // namespace scifi::kalman
