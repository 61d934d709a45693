// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/kalman/gain.hpp>

namespace scifi::kalman {

/// Update in the textbook form, P+ = (I - K H) P: the cheapest, and the first to lose symmetry and positive definiteness.
///
/// Valid where the measurement is not much more precise than the prediction; use `joseph` or `square_root` elsewhere.
struct plain {
  template <class Scalar, int N, class Measurement>
  [[nodiscard]] auto operator()(const estimate<Scalar, N>& prior, const Measurement& m) const -> updated<Scalar, N, max_measurement_dimension<Measurement>> {
    constexpr int M = max_measurement_dimension<Measurement>;
    innovation<Scalar, N, M> seen;
    detail::set_innovation(seen, m, prior.mean);
    const gain<Scalar, N, M> k = optimal_gain<Scalar, N, M, detail::seen_components_of<Measurement>()>(prior.covariance, seen);
    updated<Scalar, N, M> out;
    matrix<Scalar, N, N> a = matrix<Scalar, N, N>::Identity();
    a -= detail::times<Scalar, N, M, N>(k.weight, seen.jacobian);
    detail::multiply(out.posterior.covariance, a, [&prior](int row, int col) -> const Scalar& { return prior.covariance(row, col); });
    out.posterior.mean = prior.mean + detail::times_vector<Scalar, N, M>(k.weight, seen.residual);
    detail::complete(out, prior, seen, k);
    return out;
  }
};

}  // namespace scifi::kalman
