// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include <cmath>

#include <scifi/core/linalg.hpp>

namespace scifi::test {

/// Number with derivatives in the N components of a state.
template <int N>
using dual = Eigen::AutoDiffScalar<vector<double, N>>;

/// The state x as N independent variables.
template <int N>
[[nodiscard]] vector<dual<N>, N> variables(const vector<double, N>& x) {
  vector<dual<N>, N> out;
  for (int i = 0; i < N; ++i) out[i] = dual<N>(x[i], N, i);
  return out;
}

/// Derivative of f at x, one row a component of f; f takes and returns vectors of dual numbers.
template <int M, int N, class Function>
[[nodiscard]] matrix<double, M, N> derivative(const Function& f, const vector<double, N>& x) {
  const vector<dual<N>, M> y = f(variables<N>(x));
  matrix<double, M, N> out;
  for (int i = 0; i < M; ++i) out.row(i) = y[i].derivatives().transpose();
  return out;
}

/// Largest difference of two matrices, each column and row in the units given: element (i, j) times column_unit j over row_unit i.
template <int M, int N>
[[nodiscard]] double deviation(const matrix<double, M, N>& a, const matrix<double, M, N>& b, const vector<double, M>& row_units,
                               const vector<double, N>& column_units) {
  double worst = 0.0;
  for (int i = 0; i < M; ++i)
    for (int j = 0; j < N; ++j) {
      const double d = std::abs(a(i, j) - b(i, j)) * column_units[j] / row_units[i];
      if (!(d <= worst)) worst = d;
    }
  return worst;
}

}  // namespace scifi::test
