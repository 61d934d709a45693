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
    innovation<Scalar, N, M> seen;
    detail::set_innovation(seen, m, prior.mean);
    const gain<Scalar, N, M> k = optimal_gain<Scalar, N, M, detail::seen_components_of<Measurement>()>(prior.covariance, seen);
    updated<Scalar, N, M> out;
    matrix<Scalar, N, N> t;
    detail::set_difference(t, prior.covariance, k.weight, detail::transpose_of<Scalar, N, M>(k.cross));
    const matrix<Scalar, N, M> correction = detail::times<Scalar, N, M, M>(k.weight, seen.covariance) - detail::times_transposed<Scalar, N, N, M>(t, seen.jacobian);
    detail::set_symmetric_sum(out.posterior.covariance, t, correction, detail::transpose_of<Scalar, N, M>(k.weight));
    out.posterior.mean = prior.mean + detail::times_vector<Scalar, N, M>(k.weight, seen.residual);
    detail::complete(out, prior, seen, k);
    return out;
  }
};

}  // namespace scifi::kalman
