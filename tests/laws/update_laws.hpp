// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/kalman/measurement.hpp>
#include <scifi/kalman/updated.hpp>

namespace laws {

/// Largest difference of two estimates, means in units of the standard deviations of `a`, covariances as correlations.
template <class Scalar, int N>
Scalar estimate_distance(const scifi::kalman::estimate<Scalar, N>& a, const scifi::kalman::estimate<Scalar, N>& b) {
  Scalar worst = 0;
  const auto widen = [&worst](Scalar d) {
    const Scalar size = d < 0 ? -d : d;
    if (!(size <= worst)) worst = size;
  };
  for (int i = 0; i < N; ++i) {
    widen((a.mean(i) - b.mean(i)) / scifi::kalman::sigma(a, i));
    for (int j = 0; j < N; ++j) widen((a.covariance(i, j) - b.covariance(i, j)) / (scifi::kalman::sigma(a, i) * scifi::kalman::sigma(a, j)));
  }
  return worst;
}

/// How much the order of two independent linear measurements matters to an update policy.
template <class Update, class Scalar, int N, class A, class B>
Scalar order_dependence(const Update& update, const scifi::kalman::estimate<Scalar, N>& prior, const A& a, const B& b) {
  const auto ab = update(update(prior, a).posterior, b);
  const auto ba = update(update(prior, b).posterior, a);
  return estimate_distance(ab.posterior, ba.posterior);
}

}  // namespace laws
