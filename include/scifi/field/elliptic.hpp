// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/core/constants.hpp>
#include <scifi/core/scalar.hpp>

namespace scifi {

/// Bulirsch's general complete elliptic integral for p > 0,
///   cel(kc, p, a, b) = int_0^(pi/2) (a cos^2 + b sin^2) / ((cos^2 + p sin^2) sqrt(cos^2 + kc^2 sin^2)) dphi,
/// R. Bulirsch, Numer. Math. 13 (1969) 305; DLMF 19.2.11. K = cel(kc, 1, 1, 1), E = cel(kc, 1, 1, kc^2).
/// For kc != 0 and p > 0, to a few roundings of the larger of the two terms, derivatives of dual numbers too; NaN for p < 0.
template <scalar Scalar>
[[nodiscard]] Scalar complete_elliptic(const Scalar& kc, const Scalar& p, const Scalar& a, const Scalar& b) {
  using std::sqrt;
  // The arithmetic-geometric mean converges quadratically: when two means agree to this the next step is exact, and so is its derivative.
  constexpr double converged = 1e-12;
  constexpr int most_steps = 16;
  const Scalar two(2.0);
  Scalar root_p = sqrt(p);
  Scalar first = a + b / p;
  Scalar k = magnitude(kc);
  Scalar g = k / root_p;
  Scalar second = two * (b / root_p + a * g);
  root_p = g + root_p;
  g = Scalar(1.0);
  Scalar mean = g + k;
  Scalar product = k;
  for (int i = 0; i < most_steps && any_of(Scalar(converged) * g < magnitude(Scalar(g - k))); ++i) {
    k = two * sqrt(product);
    product = k * mean;
    const Scalar before = first;
    first = first + second / root_p;
    g = product / root_p;
    second = two * (second + before * g);
    root_p = g + root_p;
    g = mean;
    mean = k + mean;
  }
  return Scalar(0.5 * constants::pi) * (second + first * mean) / (mean * (mean + root_p));
}

/// ((2 - m) K - 2 E) / m^2 of the parameter m = 1 - kc^2: pi/16 at m = 0, without the cancellation of the three terms.
///
/// With the arithmetic-geometric mean, c_(n+1) = c_n^2 / (4 a_(n+1)), E/K = 1 - sum 2^(n-1) c_n^2 (DLMF 19.8.6), so the bracket is K sum_(n >= 1) 2^n c_n^2.
/// kc > 0; `m` is handed in because 1 - kc^2 would lose it.
template <scalar Scalar>
[[nodiscard]] Scalar elliptic_difference(const Scalar& kc, const Scalar& m) {
  using std::sqrt;
  constexpr double converged = 1e-12;
  constexpr int most_steps = 16;
  Scalar a = Scalar(0.5) * (Scalar(1.0) + kc);
  Scalar g = sqrt(kc);
  // d_n = c_n / m.
  Scalar d = Scalar(0.5) / (Scalar(1.0) + kc);
  Scalar weight(2.0);
  Scalar sum = weight * d * d;
  for (int i = 0; i < most_steps && any_of(Scalar(converged) * a < magnitude(Scalar(a - g))); ++i) {
    const Scalar next = Scalar(0.5) * (a + g);
    d = m * d * d / (Scalar(4.0) * next);
    g = sqrt(Scalar(a * g));
    a = next;
    weight = weight + weight;
    sum += weight * d * d;
  }
  // The sum is that of (c_n / m)^2: over m^2 already.
  return Scalar(0.5 * constants::pi) / a * sum;
}

}  // namespace scifi
