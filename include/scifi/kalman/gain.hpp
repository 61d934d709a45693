// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <limits>

#include <scifi/core/linalg.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/kalman/cholesky.hpp>
#include <scifi/kalman/measurement.hpp>
#include <scifi/kalman/symmetric.hpp>
#include <scifi/kalman/updated.hpp>

namespace scifi::kalman {

/// The Kalman gain and what it is made from (Kalman 1960, J. Basic Eng. 82, 35, eq. 25-27).
template <class Scalar, int N, int M>
struct gain {
  /// P H', N x M.
  matrix<Scalar, N, M> cross;
  /// S = H P H' + R, M x M.
  matrix<Scalar, M, M> residual_covariance;
  /// K = P H' S^-1, N x M.
  matrix<Scalar, N, M> weight;
  /// r' S^-1 r; NaN where S cannot be inverted.
  Scalar chi2;
  /// none, singular_innovation or not_finite.
  reason why = reason::none;
};

/// Gain of a measurement for an estimate of covariance P: by division where M = 1, by Cholesky decomposition of S otherwise.
template <class Scalar, int N, int M>
[[nodiscard]] gain<Scalar, N, M> optimal_gain(const matrix<Scalar, N, N>& p, const innovation<Scalar, N, M>& seen) {
  const Scalar nan = Scalar(std::numeric_limits<double>::quiet_NaN());
  gain<Scalar, N, M> out;
  out.cross.noalias() = p.lazyProduct(seen.jacobian.transpose());
  if constexpr (M == 1) {
    Scalar s(seen.covariance(0, 0));
    for (int i = 0; i < N; ++i) s += seen.jacobian(0, i) * out.cross(i, 0);
    const auto positive = s > Scalar(0.0);
    const Scalar inverse = Scalar(1.0) / select(positive, s, Scalar(1.0));
    const Scalar r(seen.residual(0));
    const Scalar chi2 = r * r * inverse;
    out.residual_covariance(0, 0) = s;
    out.weight = out.cross * inverse;
    out.chi2 = select(positive, chi2, nan);
    if (!any_of(positive)) out.why = any_of(is_finite<Scalar>(s)) ? reason::singular_innovation : reason::not_finite;
  } else {
    const matrix<Scalar, M, N> cross_transposed = detail::transposed<Scalar, N, M>(out.cross);
    out.residual_covariance = detail::symmetric_sum<Scalar, M, N>(seen.covariance, seen.jacobian, cross_transposed);
    const cholesky<Scalar, M> factor(out.residual_covariance);
    out.weight = detail::transposed<Scalar, M, N>(factor.template solve<N>(cross_transposed));
    const vector<Scalar, M> white = factor.template half_solve<1>(seen.residual);
    Scalar chi2(0.0);
    for (int i = 0; i < M; ++i) chi2 += white(i) * white(i);
    out.chi2 = select(factor.ok(), chi2, nan);
    if (!any_of(factor.ok())) {
      Scalar trace(0.0);
      for (int i = 0; i < M; ++i) trace += out.residual_covariance(i, i);
      out.why = any_of(is_finite<Scalar>(trace)) ? reason::singular_innovation : reason::not_finite;
    }
  }
  return out;
}

/// An update that has not moved the estimate yet: prior kept as posterior, the rest filled in. For update policies to start from.
template <class Estimate, class Scalar, int N, int M>
[[nodiscard]] basic_updated<Estimate, M> not_yet_updated(const Estimate& prior, const innovation<Scalar, N, M>& seen,
                                                         const matrix<Scalar, M, M>& residual_covariance, const Scalar& chi2, reason why) {
  basic_updated<Estimate, M> out{prior, seen.residual, residual_covariance, seen.jacobian, seen.covariance, chi2, {step_kind::update, why}, {}};
  if (why == reason::none && !any_of(is_finite<Scalar>(chi2))) out.status.why = reason::not_finite;
  return out;
}

}  // namespace scifi::kalman
