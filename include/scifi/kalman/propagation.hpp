// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/linalg.hpp>
#include <scifi/kalman/model_value.hpp>
#include <scifi/kalman/shape.hpp>

namespace scifi::kalman {

namespace detail {

template <class P, class Step>
concept has_transition = requires(const P& p, const Step& step) { p.transition(step); };
template <class P, class Scalar, int N, class Step>
concept has_propagate = requires(const P& p, const vector<Scalar, N>& x, const Step& step) { p.propagate(x, step); };

}  // namespace detail

/// Carries the state x over a step with either form of propagator; for a linear one the end is F x and the Jacobian F.
template <class Propagator, class Scalar, int N, class Step>
[[nodiscard]] propagated<Scalar, N> propagate(const Propagator& p, const vector<Scalar, N>& x, const Step& step) {
  if constexpr (detail::has_propagate<Propagator, Scalar, N, Step>) {
    const auto moved = p.propagate(x, step);
    return {detail::as_matrix<Scalar, N, 1>(moved.state), detail::as_matrix<Scalar, N, N>(moved.jacobian)};
  } else {
    propagated<Scalar, N> out;
    out.jacobian = detail::as_matrix<Scalar, N, N>(p.transition(step));
    out.state.noalias() = out.jacobian.lazyProduct(x);
    return out;
  }
}

}  // namespace scifi::kalman
