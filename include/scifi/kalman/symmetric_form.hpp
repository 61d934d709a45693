// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/kalman/correction.hpp>

namespace scifi::kalman {

/// Update in the symmetric form, P+ = P - P H' S^-1 H P as a sum of squares: the cheapest, symmetric to the last bit.
///
/// Valid where no measurement is so precise that the variance left, H P+ H', drowns in the rounding of P: R well above eps H P H'. It fails there with
/// not_positive_definite, or leaves a covariance of the size of the rounding; use `joseph` or `square_root` then. Variances between 1e-150 and 1e150, whose squares
/// are numbers.
struct symmetric_form {
  /// Writes the posterior of a measurement whose gain is known.
  template <class Scalar, int N, int M>
  [[gnu::always_inline]] static void correct(const estimate<Scalar, N>& prior, const detail::innovation_view<Scalar, N, M>& /*seen*/, const gain<Scalar, N, M>& k, estimate<Scalar, N>& posterior) {
    detail::subtract_squares<Scalar, N, M>(posterior.covariance, prior.covariance, k.decorrelated, k.factor.inverse_diagonal());
    k.move(prior.mean, posterior.mean);
  }

  template <class Scalar, int N, class Measurement>
  [[nodiscard]] auto operator()(const estimate<Scalar, N>& prior, const Measurement& m) const -> updated<Scalar, N, max_measurement_dimension<Measurement>> {
    return detail::corrected(*this, prior, m);
  }
};

}  // namespace scifi::kalman
