// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <type_traits>

#include <scifi/core/linalg.hpp>
#include <scifi/kalman/model_value.hpp>
#include <scifi/kalman/product.hpp>
#include <scifi/kalman/shape.hpp>

namespace scifi::kalman {

namespace detail {

template <class P, class Step>
concept has_transition = requires(const P& p, const Step& step) { p.transition(step); };
template <class P, class Scalar, int N, class Step>
concept has_propagate = requires(const P& p, const vector<Scalar, N>& x, const Step& step) { p.propagate(x, step); };

/// True where both parts of a model can write what they work out where it is to stay: optional, and what the propagator returns is handed to the noise.
template <class P, class Q, class Scalar, int N, class Step>
concept models_in_place = requires(const P& p, const Q& q, const propagated_view<Scalar, N>& end, matrix<Scalar, N, N>& noise, const vector<Scalar, N>& x, const Step& step) {
  q.covariance_into(noise, x, step, p.propagate_into(end, x, step));
};

/// out = value, of any scalar; a plain number fills a 1 x 1 matrix.
template <class Scalar, int Rows, int Cols, class T>
[[gnu::always_inline]] inline void assign_matrix(matrix<Scalar, Rows, Cols>& out, const T& value) {
  if constexpr (std::is_same_v<T, matrix<Scalar, Rows, Cols>>) copy_columns<Scalar, Rows, Cols>(out, value);
  else out = as_matrix<Scalar, Rows, Cols>(value);
}

}  // namespace detail

/// Carries the state x over a step with either form of propagator; for a linear one the end is F x and the Jacobian F.
template <class Propagator, class Scalar, int N, class Step>
[[nodiscard]] propagated<Scalar, N> propagate(const Propagator& p, const vector<Scalar, N>& x, const Step& step) {
  if constexpr (detail::has_propagate<Propagator, Scalar, N, Step>) {
    if constexpr (std::is_same_v<decltype(p.propagate(x, step)), propagated<Scalar, N>>) {
      return p.propagate(x, step);
    } else {
      const auto moved = p.propagate(x, step);
      return {detail::as_matrix<Scalar, N, 1>(moved.state), detail::as_matrix<Scalar, N, N>(moved.jacobian)};
    }
  } else {
    propagated<Scalar, N> out;
    detail::assign_matrix(out.jacobian, p.transition(step));
    out.state = detail::times_vector<Scalar, N, N>(out.jacobian, x);
    return out;
  }
}

namespace detail {

/// As `propagate`, with whatever else the propagator puts into its result, for the noise to use again.
template <class Propagator, class Scalar, int N, class Step>
[[nodiscard]] auto propagate_fully(const Propagator& p, const vector<Scalar, N>& x, const Step& step) {
  if constexpr (requires { requires std::is_base_of_v<propagated<Scalar, N>, decltype(p.propagate(x, step))>; }) return p.propagate(x, step);
  else return kalman::propagate(p, x, step);
}

}  // namespace detail

}  // namespace scifi::kalman
