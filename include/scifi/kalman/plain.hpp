// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/kalman/correction.hpp>

namespace scifi::kalman {

/// Update in the textbook form, P+ = (I - K H) P: the cheapest, and the first to lose symmetry and positive definiteness.
///
/// Valid where the measurement is not much more precise than the prediction; use `joseph` or `square_root` elsewhere.
struct plain {
  /// Writes the posterior of a measurement whose gain is known.
  template <class Scalar, int N, int M>
  [[gnu::always_inline]] static void correct(const estimate<Scalar, N>& prior, const detail::innovation_view<Scalar, N, M>& seen, const gain<Scalar, N, M>& k, estimate<Scalar, N>& posterior) {
    matrix<Scalar, N, N> a = matrix<Scalar, N, N>::Identity();
    a -= detail::times<Scalar, N, M, N>(k.weight(), seen.jacobian);
    detail::multiply(posterior.covariance, a, [&prior](int row, int col) -> const Scalar& { return prior.covariance(row, col); });
    k.move(prior.mean, posterior.mean);
  }

  template <class Scalar, int N, class Measurement>
  [[nodiscard]] auto operator()(const estimate<Scalar, N>& prior, const Measurement& m) const -> updated<Scalar, N, max_measurement_dimension<Measurement>> {
    return detail::corrected(*this, prior, m);
  }
};

}  // namespace scifi::kalman
