// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/kalman/gain.hpp>

namespace scifi::kalman {

/// Update in Joseph's form, P+ = (I - K H) P (I - K H)' + K R K' (Bucy and Joseph, Filtering for Stochastic Processes, 1968).
///
/// The result is symmetric to the last bit, and rounding of the gain enters it in second order only. Evaluated as
/// T = P - K (P H')', P+ = T + (K R - T H') K': the second term is zero but for rounding, whose effect on T it cancels.
struct joseph {
  template <class Scalar, int N, class Measurement>
  [[nodiscard]] auto operator()(const estimate<Scalar, N>& prior, const Measurement& m) const -> updated<Scalar, N, max_measurement_dimension<Measurement>> {
    constexpr int M = max_measurement_dimension<Measurement>;
    const innovation<Scalar, N, M> seen = compare(m, prior.mean);
    const gain<Scalar, N, M> k = optimal_gain(prior.covariance, seen);
    updated<Scalar, N, M> out = not_yet_updated(prior, seen, k.residual_covariance, k.chi2, k.why);
    if (!out.status.ok()) return out;

    matrix<Scalar, N, N> t = prior.covariance;
    t.noalias() -= k.weight.lazyProduct(k.cross.transpose());
    matrix<Scalar, N, M> correction = k.weight.lazyProduct(seen.covariance);
    correction.noalias() -= t.lazyProduct(seen.jacobian.transpose());
    const estimate<Scalar, N> after{prior.mean + k.weight.lazyProduct(seen.residual), detail::symmetric_sum<Scalar, N, M>(t, correction, k.weight)};

    out.status.why = fault_of(after.mean, after.covariance);
    if (out.status.ok()) out.posterior = after;
    return out;
  }
};

}  // namespace scifi::kalman
