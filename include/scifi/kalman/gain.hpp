// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <limits>

#include <scifi/core/linalg.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/kalman/ldl.hpp>
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
  /// P H' L'^-1 (N x M) and 1 / D (M) of S = L D L': the columns z_k give P H' S^-1 H P as the sum of z_k z_k' / D_k.
  matrix<Scalar, N, M> decorrelated;
  vector<Scalar, M> inverse_diagonal;
  /// K = P H' S^-1, N x M.
  matrix<Scalar, N, M> weight;
  /// r' S^-1 r; NaN where S cannot be inverted.
  Scalar chi2;
  /// none, singular_innovation or not_finite.
  reason why = reason::none;
};

/// Gain of a measurement for an estimate of covariance P, through S = L D L'. Columns of H whose bit is not set in Seen are taken to be zero.
template <class Scalar, int N, int M, unsigned Seen = ~0u>
[[nodiscard, gnu::always_inline]] inline gain<Scalar, N, M> optimal_gain(const matrix<Scalar, N, N>& p, const innovation<Scalar, N, M>& seen) {
  gain<Scalar, N, M> out;
  detail::multiply<Seen>(out.cross, p, detail::transpose_of<Scalar, M, N>(seen.jacobian));
  detail::multiply<Seen>(out.residual_covariance, seen.jacobian, [&out](int k, int j) -> const Scalar& { return out.cross(k, j); });
  out.residual_covariance += seen.covariance;
  detail::mirror<Scalar, M>(out.residual_covariance);
  const ldl<Scalar, M> factor(out.residual_covariance);
  const auto regular = factor.ok();
  detail::copy_columns<Scalar, N, M>(out.decorrelated, out.cross);
  factor.template decorrelate<N>(out.decorrelated);
  factor.template recombine<N>(out.weight, out.decorrelated);
  out.inverse_diagonal = factor.inverse_diagonal();
  const Scalar chi2 = factor.inverse_form(seen.residual);
  out.chi2 = select(regular, chi2, Scalar(std::numeric_limits<double>::quiet_NaN()));
  if (!any_of(regular)) {
    Scalar trace(0.0);
    for (int i = 0; i < M; ++i) trace += out.residual_covariance(i, i);
    out.why = any_of(is_finite<Scalar>(trace)) ? reason::singular_innovation : reason::not_finite;
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

namespace detail {

/// Fills in all but the posterior, which stands there already, judges it, and puts the prior back where the update failed.
template <class Scalar, int N, int M>
[[gnu::always_inline]] inline void complete(updated<Scalar, N, M>& out, const estimate<Scalar, N>& prior, const innovation<Scalar, N, M>& seen, const gain<Scalar, N, M>& k) {
  out.residual = seen.residual;
  out.residual_covariance = k.residual_covariance;
  out.jacobian = seen.jacobian;
  out.measurement_covariance = seen.covariance;
  out.chi2 = k.chi2;
  out.status = {step_kind::update, k.why};
  if (k.why == reason::none) out.status.why = any_of(is_finite<Scalar>(k.chi2)) ? fault_of(out.posterior.mean, out.posterior.covariance) : reason::not_finite;
  if (!out.status.ok()) out.posterior = prior;
}

}  // namespace detail

}  // namespace scifi::kalman
