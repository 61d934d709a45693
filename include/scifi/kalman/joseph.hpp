// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/kalman/correction.hpp>

namespace scifi::kalman {

/// Update in Joseph's form, P+ = (I - K H) P (I - K H)' + K R K' (Bucy and Joseph, Filtering for Stochastic Processes, 1968).
///
/// The result is symmetric to the last bit, and rounding of the gain enters it in second order only. Evaluated as
/// T = P - K (P H')', P+ = T + (K R - T H') K': the second term is zero but for rounding, whose effect on T it cancels.
struct joseph {
  /// Writes the posterior of a measurement whose gain is known.
  template <class Scalar, int N, int M>
  [[gnu::always_inline]] static void correct(const estimate<Scalar, N>& prior, const detail::innovation_view<Scalar, N, M>& seen, const gain<Scalar, N, M>& k, estimate<Scalar, N>& posterior) {
    const matrix<Scalar, N, M> weight = k.weight();
    matrix<Scalar, N, N> t;
    detail::set_difference(t, prior.covariance, weight, detail::transpose_of<Scalar, N, M>(k.cross));
    const matrix<Scalar, N, M> correction = detail::times<Scalar, N, M, M>(weight, seen.covariance) - detail::times_transposed<Scalar, N, N, M>(t, seen.jacobian);
    detail::set_symmetric_sum(posterior.covariance, t, correction, detail::transpose_of<Scalar, N, M>(weight));
    posterior.mean = prior.mean + detail::times_vector<Scalar, N, M>(weight, seen.residual);
  }

  template <class Scalar, int N, class Measurement>
  [[nodiscard]] auto operator()(const estimate<Scalar, N>& prior, const Measurement& m) const -> updated<Scalar, N, max_measurement_dimension<Measurement>> {
    return detail::corrected(*this, prior, m);
  }
};

}  // namespace scifi::kalman
