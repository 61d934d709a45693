// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/linalg.hpp>
#include <scifi/kalman/shape.hpp>

namespace scifi::kalman {

/// What `propagate(x, step)` returns: the state at the end of the step and its derivative, jacobian(i, j) = d end_i / d start_j.
template <class Scalar, int N>
struct propagated {
  vector<Scalar, N> state;
  matrix<Scalar, N, N> jacobian;
};

template <class State, class Jacobian>
propagated(const Eigen::MatrixBase<State>&, const Eigen::MatrixBase<Jacobian>&) -> propagated<typename State::Scalar, State::RowsAtCompileTime>;

/// The same for a propagator that writes it where it is to stay.
template <class Scalar, int N>
struct propagated_view {
  vector<Scalar, N>& state;
  matrix<Scalar, N, N>& jacobian;
};

/// What `project(x)` returns: the expected measurement and its derivative, jacobian(i, j) = d value_i / d x_j (M x N).
template <class Scalar, int M, int N>
struct projected {
  vector<Scalar, M> value;
  matrix<Scalar, M, N> jacobian;
};

template <class Value, class Jacobian>
projected(const Eigen::MatrixBase<Value>&, const Eigen::MatrixBase<Jacobian>&)
    -> projected<typename Value::Scalar, Value::RowsAtCompileTime, Jacobian::ColsAtCompileTime>;

}  // namespace scifi::kalman
