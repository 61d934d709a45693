// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/Eigenvalues>

#include <cmath>
#include <limits>

#include <scifi/kalman/process_noise.hpp>
#include <scifi/kalman/propagation.hpp>

namespace laws {

/// Smallest eigenvalue of a step's noise, scaled to a unit diagonal; minus infinity where it is not symmetric. Must not be below -rounding.
template <class Q, class P, class Scalar, int N, class Step>
Scalar smallest_noise_eigenvalue(const Q& q, const P& p, const scifi::vector<Scalar, N>& x, const Step& step) {
  const auto moved = scifi::kalman::propagate(p, x, step);
  scifi::matrix<Scalar, N, N> c = scifi::kalman::detail::noise_covariance<Scalar, N>(q, x, step, moved);
  if ((c - c.transpose()).cwiseAbs().maxCoeff() > 0) return -std::numeric_limits<Scalar>::infinity();
  scifi::vector<Scalar, N> scale;
  for (int i = 0; i < N; ++i) scale(i) = c(i, i) > 0 ? 1 / std::sqrt(c(i, i)) : Scalar(1);
  c = scale.asDiagonal() * c * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<scifi::matrix<Scalar, N, N>>(c, Eigen::EigenvaluesOnly).eigenvalues().minCoeff();
}

/// Size of a step's noise: zero for a step of no length.
template <class Q, class P, class Scalar, int N, class Step>
Scalar noise_norm(const Q& q, const P& p, const scifi::vector<Scalar, N>& x, const Step& step) {
  return scifi::kalman::detail::noise_covariance<Scalar, N>(q, x, step, scifi::kalman::propagate(p, x, step)).norm();
}

}  // namespace laws
