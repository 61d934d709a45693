// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <limits>

namespace scifi {

/// Q(shape, x), the probability that a gamma variate of this shape and unit scale exceeds x (DLMF 8.2.4); Q(ndf/2, chi2/2) is that of chi-squared with a number
/// of degrees of freedom that need not be whole; `chi_squared_probability` is the finite sum for those that are. Series (DLMF 8.7.1) below x = shape + 1,
/// continued fraction (DLMF 8.9.2) above; relative error below 1e-9 for 0.05 <= shape <= 150. Needs 0 < shape <= 150 and x >= 0, else NaN.
[[nodiscard]] inline double gamma_probability(double shape, double x) {
  constexpr double largest_shape = 150.0;  // beyond, the gamma function comes near the largest number
  if (!(shape > 0.0) || !(shape <= largest_shape) || !(x >= 0.0)) return std::numeric_limits<double>::quiet_NaN();
  if (x == 0.0) return 1.0;
  if (std::isinf(x)) return 0.0;
  constexpr double enough = 1e-13;
  constexpr int most = 1000;
  const double front = std::exp(-x + shape * std::log(x)) / std::tgamma(shape);  // lgamma would write a global sign
  if (x < shape + 1.0) {
    double term = 1.0 / shape;
    double sum = term;
    for (int n = 1; n < most && term > enough * sum; ++n) {
      term *= x / (shape + n);
      sum += term;
    }
    const double below = front * sum;
    return below < 1.0 ? 1.0 - below : 0.0;
  }
  // Lentz's method; the denominators stay positive here.
  double b = x + 1.0 - shape;
  double c = std::numeric_limits<double>::infinity();
  double d = 1.0 / b;
  double fraction = d;
  for (int n = 1; n < most; ++n) {
    const double a = -n * (n - shape);
    b += 2.0;
    d = 1.0 / (a * d + b);
    c = b + a / c;
    const double factor = c * d;
    fraction *= factor;
    if (std::abs(factor - 1.0) < enough) break;
  }
  return front * fraction;
}

}  // namespace scifi
