// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/kalman/gain.hpp>

namespace scifi::kalman {

/// Update in the symmetric form, P+ = P - P H' S^-1 H P as a sum of squares: the cheapest, symmetric to the last bit.
///
/// Valid where no measurement is so precise that the variance left, H P+ H', drowns in the rounding of P: R well above eps H P H'. It fails there with
/// not_positive_definite, or leaves a covariance of the size of the rounding; use `joseph` or `square_root` then. Variances between 1e-150 and 1e150, whose squares
/// are numbers.
struct symmetric_form {
  template <class Scalar, int N, class Measurement>
  [[nodiscard]] auto operator()(const estimate<Scalar, N>& prior, const Measurement& m) const -> updated<Scalar, N, max_measurement_dimension<Measurement>> {
    constexpr int M = max_measurement_dimension<Measurement>;
    innovation<Scalar, N, M> seen;
    detail::set_innovation(seen, m, prior.mean);
    const gain<Scalar, N, M> k = optimal_gain<Scalar, N, M, detail::seen_components_of<Measurement>()>(prior.covariance, seen);
    updated<Scalar, N, M> out;
    detail::subtract_squares<Scalar, N, M>(out.posterior.covariance, prior.covariance, k.decorrelated, k.inverse_diagonal);
    out.posterior.mean = prior.mean + detail::times_vector<Scalar, N, M>(k.weight, seen.residual);
    detail::complete(out, prior, seen, k);
    return out;
  }
};

}  // namespace scifi::kalman
