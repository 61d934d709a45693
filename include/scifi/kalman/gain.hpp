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

/// The Kalman gain and what it is made from (Kalman 1960, J. Basic Eng. 82, 35, eq. 25-27), through S = L D L'.
template <class Scalar, int N, int M>
struct gain {
  /// P H', N x M.
  matrix<Scalar, N, M> cross;
  /// S = H P H' + R, M x M, and its factors.
  matrix<Scalar, M, M> residual_covariance;
  ldl<Scalar, M> factor;
  /// z = P H' L'^-1 (N x M), and D^-1 L^-1 r (M): K S K' is the sum of z_k z_k' / D_k, K r is z times the latter.
  matrix<Scalar, N, M> decorrelated;
  vector<Scalar, M> scaled_residual;
  /// r' S^-1 r; NaN where S cannot be inverted.
  Scalar chi2;
  /// none, singular_innovation, not_finite, or not_positive_definite for a measurement with a negative variance.
  reason why = reason::none;

  /// K = P H' S^-1, N x M.
  [[nodiscard, gnu::always_inline]] matrix<Scalar, N, M> weight() const {
    matrix<Scalar, N, M> out;
    factor.template recombine<N>(out, decorrelated);
    return out;
  }
  /// to = from + K r.
  [[gnu::always_inline]] void move(const vector<Scalar, N>& from, vector<Scalar, N>& to) const {
    detail::set_vector_sum<Scalar, N, M>(to, from, decorrelated, scaled_residual);
  }
};

namespace detail {

/// Gain of a measurement for an estimate of covariance P. Columns of H whose bit is not set in Seen are taken to be zero.
template <unsigned Seen, class Scalar, int N, int M>
[[gnu::always_inline]] inline void set_gain(gain<Scalar, N, M>& out, const matrix<Scalar, N, N>& p, const innovation_view<Scalar, N, M>& seen) {
  multiply<Seen>(out.cross, p, transpose_of<Scalar, M, N>(seen.jacobian));
  each_index<M>([&](int j) __attribute__((always_inline)) {
    for (int i = 0; i <= j; ++i) {
      const Scalar s = add_dot<N, Seen, Scalar>(seen.covariance(i, j), [&](int k) -> const Scalar& { return seen.jacobian(i, k); }, [&](int k) -> const Scalar& { return out.cross(k, j); });
      out.residual_covariance(i, j) = s;
      out.residual_covariance(j, i) = s;
    }
  });
  out.factor.factorise(out.residual_covariance);
  Scalar least(seen.covariance(0, 0));
  for (int i = 1; i < M; ++i) least = smaller_of<Scalar>(least, seen.covariance(i, i));
  const auto regular = out.factor.ok() && least >= Scalar(0.0);
  copy_columns<Scalar, N, M>(out.decorrelated, out.cross);
  out.factor.template decorrelate<N>(out.decorrelated);
  const vector<Scalar, M> y = out.factor.half_solve(seen.residual);
  Scalar chi2(0.0);
  for (int k = 0; k < M; ++k) {
    out.scaled_residual(k) = y(k) * out.factor.inverse_diagonal()(k);
    chi2 += y(k) * out.scaled_residual(k);
  }
  out.chi2 = select(regular, chi2, Scalar(std::numeric_limits<double>::quiet_NaN()));
  if (!any_of(regular)) {
    Scalar trace(0.0);
    for (int i = 0; i < M; ++i) trace += out.residual_covariance(i, i);
    out.why = any_of(is_finite<Scalar>(trace)) ? reason::singular_innovation : reason::not_finite;
    if (any_of(least < Scalar(0.0))) out.why = reason::not_positive_definite;
  }
}

}  // namespace detail

/// Gain of a measurement for an estimate of covariance P (N x N).
template <class Scalar, int N, int M>
[[nodiscard]] gain<Scalar, N, M> optimal_gain(const matrix<Scalar, N, N>& p, const innovation<Scalar, N, M>& seen) {
  gain<Scalar, N, M> out;
  detail::set_gain<~0u, Scalar, N, M>(out, p, {seen.residual, seen.jacobian, seen.covariance});
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
