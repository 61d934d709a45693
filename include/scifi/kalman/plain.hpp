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
    const innovation<Scalar, N, M> seen = compare(m, prior.mean);
    const gain<Scalar, N, M> k = optimal_gain(prior.covariance, seen);
    updated<Scalar, N, M> out = not_yet_updated(prior, seen, k.residual_covariance, k.chi2, k.why);
    if (!out.status.ok()) return out;

    matrix<Scalar, N, N> a = matrix<Scalar, N, N>::Identity();
    a.noalias() -= k.weight.lazyProduct(seen.jacobian);
    const estimate<Scalar, N> after{prior.mean + k.weight.lazyProduct(seen.residual), a.lazyProduct(prior.covariance)};

    out.status.why = fault_of(after.mean, after.covariance);
    if (out.status.ok()) out.posterior = after;
    return out;
  }
};

}  // namespace scifi::kalman
