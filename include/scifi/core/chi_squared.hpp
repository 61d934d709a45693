// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <limits>

#include <scifi/core/constants.hpp>

namespace scifi {

/// Probability that chi-squared with `ndf` degrees of freedom exceeds `chi2`: Q(ndf/2, chi2/2), by its finite sum (Abramowitz and Stegun 26.4.4 and 26.4.5).
/// ndf >= 1 and chi2 >= 0, infinity included; NaN for less than that and for NaN. The time grows with ndf.
[[nodiscard]] inline double chi_squared_probability(double chi2, int ndf) {
  constexpr double beyond_any_ndf = 1.0e12;
  if (!(chi2 >= 0.0) || ndf < 1) return std::numeric_limits<double>::quiet_NaN();
  if (chi2 > beyond_any_ndf) return 0.0;
  const double x = 0.5 * chi2;
  const bool odd = ndf % 2 == 1;
  // Terms x^a e^-x / Gamma(a + 1) for a = 1/2, 3/2, ... or 0, 1, ...; times e^-exponent, so that no term of a large x leaves the range of numbers.
  constexpr double largest_exponent = 700.0;
  const double step = std::exp(largest_exponent / 2.0);
  double exponent = std::fmin(x, largest_exponent) - x;
  double a = odd ? 0.5 : 0.0;
  double term = (odd ? 2.0 * std::sqrt(x / constants::pi) : 1.0) * std::exp(-x - exponent);
  double sum = 0.0;
  for (; a + 0.75 < 0.5 * ndf; a += 1.0) {
    sum += term;
    term *= x / (a + 1.0);
    if (term > step) {
      term /= step;
      sum /= step;
      exponent += largest_exponent / 2.0;
    }
  }
  const double probability = (odd ? std::erfc(std::sqrt(x)) : 0.0) + sum * std::exp(exponent);
  return probability < 1.0 ? probability : 1.0;
}

}  // namespace scifi
