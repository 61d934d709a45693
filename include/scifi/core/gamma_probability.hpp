// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <limits>

#include <scifi/core/constants.hpp>

namespace scifi {

namespace detail {

/// e^-x x^shape / Gamma(shape).
[[nodiscard]] inline double gamma_density_times_x(double shape, double x) {
  constexpr double largest_tabled = 150.0;  // beyond, the gamma function comes near the largest number
  if (shape <= largest_tabled) return std::exp(-x + shape * std::log(x)) / std::tgamma(shape);  // lgamma would write a global sign
  // Stirling's series (DLMF 5.11.1) about x = shape, where the large terms cancel.
  const double off = (x - shape) / shape;
  const double per_shape = 1.0 / shape;
  return std::sqrt(shape / (2.0 * constants::pi)) * std::exp(shape * (std::log1p(off) - off) - per_shape / 12.0 + per_shape * per_shape * per_shape / 360.0);
}

}  // namespace detail

/// Q(shape, x), the probability that a gamma variate of this shape and unit scale exceeds x (DLMF 8.2.4); Q(ndf/2, chi2/2) is that of chi-squared with a number
/// of degrees of freedom that need not be whole; `chi_squared_probability` is the finite sum for those that are. Series (DLMF 8.7.1) below x = shape + 1,
/// continued fraction (DLMF 8.9.2) above; relative error below 1e-9 for 0.05 <= shape <= 1e4. For larger shapes the cube root is taken as normal (Wilson and
/// Hilferty, Proc. Natl. Acad. Sci. 17 (1931) 684), within 1e-6. Needs shape > 0 and x >= 0, else NaN.
[[nodiscard]] inline double gamma_probability(double shape, double x) {
  if (!(shape > 0.0) || !(x >= 0.0)) return std::numeric_limits<double>::quiet_NaN();
  if (x == 0.0) return 1.0;
  if (std::isinf(x)) return 0.0;
  constexpr double summed_up_to = 1.0e4;
  if (shape > summed_up_to) return 0.5 * std::erfc((std::cbrt(x / shape) - (1.0 - 1.0 / (9.0 * shape))) * (3.0 * std::sqrt(0.5 * shape)));
  constexpr double enough = 1e-13;
  constexpr int most = 1000;
  const double front = detail::gamma_density_times_x(shape, x);
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
