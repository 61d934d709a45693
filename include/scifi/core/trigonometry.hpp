// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/core/scalar.hpp>

namespace scifi {

/// Sine and cosine of one angle.
template <scalar Scalar>
struct sine_and_cosine {
  Scalar sine, cosine;
};

/// Both at once; a pack overloads it, and reduces its angle once.
template <scalar Scalar>
[[nodiscard]] sine_and_cosine<Scalar> sincos_of(const Scalar& t) {
  using std::cos;
  using std::sin;
  return {Scalar(sin(t)), Scalar(cos(t))};
}

/// The functions of a turning angle that a helix is made of, smooth through zero.
///
/// s1 = sin(t)/t, c1 = (1 - cos(t))/t and their derivatives in t; sine and cosine beside them.
/// Below |t| = 0.5 all come from two power series (DLMF 4.19), (t - sin t)/t^3 and (1 - cos t)/t^2, whose first omitted term is below 2e-17; above, cancellation in
/// the derivatives costs less than a factor 1/t^2 = 4 of the rounding error. Any finite t is valid.
template <scalar Scalar>
struct turning {
  Scalar sine, cosine;
  Scalar s1, c1;
  Scalar d_s1, d_c1;
};

/// Evaluates `turning` at the angle t (rad).
template <scalar Scalar>
[[nodiscard, gnu::always_inline]] inline turning<Scalar> turning_at(const Scalar& t) {
  const auto small = magnitude(t) < Scalar(0.5);
  const Scalar q = t * t;

  // Horner in q = t^2: (t - sin t)/t^3 = sum (-q)^k/(2k+3)!, (1 - cos t)/t^2 = sum (-q)^k/(2k+2)!.
  const auto series = [&q](double c0, double c1, double c2, double c3, double c4, double c5, double c6) {
    return Scalar(Scalar(c0) + q * (Scalar(c1) + q * (Scalar(c2) + q * (Scalar(c3) + q * (Scalar(c4) + q * (Scalar(c5) + q * Scalar(c6)))))));
  };
  const Scalar lag = series(1.0 / 6, -1.0 / 120, 1.0 / 5040, -1.0 / 362880, 1.0 / 39916800, -1.0 / 6227020800.0, 1.0 / 1307674368000.0);
  const Scalar rise = series(0.5, -1.0 / 24, 1.0 / 720, -1.0 / 40320, 1.0 / 3628800, -1.0 / 479001600, 1.0 / 87178291200.0);
  const Scalar s1_series = Scalar(1.0) - q * lag;
  const turning<Scalar> by_series{t * s1_series, Scalar(1.0) - q * rise, s1_series, t * rise, t * (lag - rise), s1_series - rise};
  if (all_of(small)) return by_series;

  // Each lane of a pack gets what it would get alone.
  const sine_and_cosine<Scalar> at = sincos_of(t);
  const Scalar per_t = Scalar(1.0) / select(small, Scalar(1.0), t);
  const Scalar s1 = at.sine * per_t;
  const Scalar c1 = (Scalar(1.0) - at.cosine) * per_t;
  return {select(small, by_series.sine, at.sine),
          select(small, by_series.cosine, at.cosine),
          select(small, by_series.s1, s1),
          select(small, by_series.c1, c1),
          select(small, by_series.d_s1, Scalar((at.cosine - s1) * per_t)),
          select(small, by_series.d_c1, Scalar((at.sine - c1) * per_t))};
}

}  // namespace scifi
