// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <limits>

#include <scifi/kalman/factored_estimate.hpp>
#include <scifi/kalman/gain.hpp>
#include <scifi/kalman/triangular.hpp>

namespace scifi::kalman {

/// Update of a factor of the covariance instead of the covariance (array form: Kailath, Sayed, Hassibi, Linear Estimation, section 12.3).
///
/// [[R^1/2, H L], [0, L]] is made lower triangular, [[S^1/2, 0], [K S^1/2, L+]]. The condition number that counts is the square root
/// of the covariance's. A `factored_estimate` stays factored; an `estimate` is factored before and multiplied out after.
struct square_root {
  template <class Scalar, int N, class Measurement>
  [[nodiscard]] auto operator()(const factored_estimate<Scalar, N>& prior, const Measurement& m) const
      -> basic_updated<factored_estimate<Scalar, N>, max_measurement_dimension<Measurement>> {
    constexpr int M = max_measurement_dimension<Measurement>;
    const innovation<Scalar, N, M> seen = compare(m, prior.mean);
    matrix<Scalar, M + N, M + N> array = matrix<Scalar, M + N, M + N>::Zero();
    array.template topLeftCorner<M, M>() = semidefinite_factor<Scalar, M>(seen.covariance);
    array.template topRightCorner<M, N>() = seen.jacobian.lazyProduct(prior.factor);
    array.template bottomRightCorner<N, N>() = prior.factor;
    const matrix<Scalar, M + N, M + N> lower = lower_triangular<Scalar, M + N, M + N>(array);

    // white = S^-1/2 residual, by forward substitution; the mean moves by (K S^1/2) white.
    vector<Scalar, M> white;
    Scalar chi2(0.0);
    Scalar least(lower(0, 0)), variance(seen.covariance(0, 0));
    for (int i = 0; i < M; ++i) {
      Scalar sum(seen.residual(i));
      for (int k = 0; k < i; ++k) sum -= lower(i, k) * white(k);
      const auto positive = lower(i, i) > Scalar(0.0);
      white(i) = sum / select(positive, lower(i, i), Scalar(1.0));
      chi2 += white(i) * white(i);
      least = smaller_of<Scalar>(least, lower(i, i));
      variance = smaller_of<Scalar>(variance, seen.covariance(i, i));
    }
    // The factor of a negative variance would be taken for zero.
    const auto regular = least > Scalar(0.0) && variance >= Scalar(0.0);
    chi2 = select(regular, chi2, Scalar(std::numeric_limits<double>::quiet_NaN()));
    const matrix<Scalar, M, M> root = lower.template topLeftCorner<M, M>();
    const matrix<Scalar, M, M> s = detail::symmetric_sum<Scalar, M, M>(matrix<Scalar, M, M>::Zero(), root, root);
    reason why = reason::none;
    if (!any_of(regular)) why = any_of(is_finite<Scalar>(s(0, 0))) ? reason::singular_innovation : reason::not_finite;
    if (!any_of(regular) && any_of(variance < Scalar(0.0))) why = reason::not_positive_definite;
    auto out = not_yet_updated(prior, seen, s, chi2, why);
    if (!out.status.ok()) return out;

    const factored_estimate<Scalar, N> after{prior.mean + lower.template bottomLeftCorner<N, M>().lazyProduct(white),
                                             lower.template bottomRightCorner<N, N>()};
    out.status.why = fault_of(after.mean, after.factor);
    if (out.status.ok()) out.posterior = after;
    return out;
  }

  template <class Scalar, int N, class Measurement>
  [[nodiscard]] auto operator()(const estimate<Scalar, N>& prior, const Measurement& m) const -> updated<Scalar, N, max_measurement_dimension<Measurement>> {
    const auto u = (*this)(factored(prior), m);
    return {u.status.ok() ? unfactored(u.posterior) : prior, u.residual, u.residual_covariance, u.jacobian, u.measurement_covariance, u.chi2, u.status, u.outlier};
  }
};

}  // namespace scifi::kalman
