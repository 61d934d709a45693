// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/core/scalar.hpp>

namespace scifi {

/// The functions of a turning angle that a helix is made of, smooth through zero.
///
/// s1 = sin(t)/t, c1 = (1 - cos(t))/t and their derivatives in t; sine and cosine beside them.
/// Below |t| = 0.5 the quotients are power series (DLMF 4.19) whose first omitted term is below 2e-17; above, cancellation in
/// the derivatives costs less than a factor 1/t^2 = 4 of the rounding error. Any finite t is valid.
template <scalar Scalar>
struct turning {
  Scalar sine, cosine;
  Scalar s1, c1;
  Scalar d_s1, d_c1;
};

/// Evaluates `turning` at the angle t (rad).
template <scalar Scalar>
[[nodiscard]] turning<Scalar> turning_at(const Scalar& t) {
  using std::cos;
  using std::sin;
  const auto small = magnitude(t) < Scalar(0.5);
  const Scalar q = t * t;

  // Horner in q = t^2: sin(t)/t = sum (-q)^k/(2k+1)!, (1-cos t)/t = t sum (-q)^k/(2k+2)!.
  const auto series = [&q](double c0, double c1, double c2, double c3, double c4, double c5, double c6) {
    return Scalar(Scalar(c0) + q * (Scalar(c1) + q * (Scalar(c2) + q * (Scalar(c3) + q * (Scalar(c4) + q * (Scalar(c5) + q * Scalar(c6)))))));
  };
  const Scalar s1_series = series(1.0, -1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880, -1.0 / 39916800, 1.0 / 6227020800.0);
  const Scalar c1_over_t = series(0.5, -1.0 / 24, 1.0 / 720, -1.0 / 40320, 1.0 / 3628800, -1.0 / 479001600, 1.0 / 87178291200.0);
  // d/dt: s1' = t sum_k 2k (-1)^k q^(k-1)/(2k+1)!, c1' = sum_k (2k+1)(-q)^k/(2k+2)!.
  const Scalar d_s1_over_t = series(-2.0 / 6, 4.0 / 120, -6.0 / 5040, 8.0 / 362880, -10.0 / 39916800, 12.0 / 6227020800.0, -14.0 / 1307674368000.0);
  const Scalar d_c1_series = series(0.5, -3.0 / 24, 5.0 / 720, -7.0 / 40320, 9.0 / 3628800, -11.0 / 479001600, 13.0 / 87178291200.0);
  const Scalar c1_series = t * c1_over_t;
  const Scalar d_s1_series = t * d_s1_over_t;
  const Scalar sine_series = t * s1_series;
  const Scalar cosine_series = Scalar(1.0) - t * c1_series;
  if (all_of(small)) return {sine_series, cosine_series, s1_series, c1_series, d_s1_series, d_c1_series};

  // Each lane of a pack gets what it would get alone.
  const Scalar sine = select(small, sine_series, Scalar(sin(t)));
  const Scalar cosine = select(small, cosine_series, Scalar(cos(t)));
  const Scalar safe = select(small, Scalar(1.0), t);
  const Scalar s1 = select(small, s1_series, Scalar(sine / safe));
  const Scalar c1 = select(small, c1_series, Scalar((Scalar(1.0) - cosine) / safe));
  const Scalar d_s1 = select(small, d_s1_series, Scalar((cosine - s1) / safe));
  const Scalar d_c1 = select(small, d_c1_series, Scalar((sine - c1) / safe));
  return {sine, cosine, s1, c1, d_s1, d_c1};
}

}  // namespace scifi
