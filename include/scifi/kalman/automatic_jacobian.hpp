// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <concepts>

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include <scifi/kalman/concepts.hpp>

namespace scifi::kalman {

/// A propagator made from a callable f(x, step) that returns the state at the end, templated on the scalar of x.
///
/// The Jacobian comes from dual numbers (forward differentiation, exact to rounding), at the cost of N + 1 evaluations.
/// f must find its functions by argument-dependent lookup: `using std::sqrt; sqrt(x)`.
template <class Function>
struct automatic_jacobian {
  Function f;

  template <class Scalar, int N, class Step>
    requires std::invocable<const Function&, const vector<Eigen::AutoDiffScalar<vector<Scalar, N>>, N>&, const Step&>
  [[nodiscard]] propagated<Scalar, N> propagate(const vector<Scalar, N>& x, const Step& step) const {
    using dual = Eigen::AutoDiffScalar<vector<Scalar, N>>;
    vector<dual, N> start;
    for (int i = 0; i < N; ++i) start(i) = dual(x(i), N, i);
    const vector<dual, N> end = f(start, step);
    propagated<Scalar, N> out;
    for (int i = 0; i < N; ++i) {
      out.state(i) = end(i).value();
      out.jacobian.row(i) = end(i).derivatives().transpose();
    }
    return out;
  }
};

template <class Function>
automatic_jacobian(Function) -> automatic_jacobian<Function>;

namespace detail {

template <class Function>
struct state_space_of<automatic_jacobian<Function>> : state_space_of<Function> {};

}  // namespace detail

}  // namespace scifi::kalman
