// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <limits>

#include <scifi/core/constants.hpp>

namespace scifi {

/// Probability that chi-squared with `ndf` degrees of freedom exceeds `chi2`: Q(ndf/2, chi2/2), by its finite sum (Abramowitz and Stegun 26.4.4 and 26.4.5).
/// ndf >= 1, 0 <= chi2 < 1400 or infinite; NaN for less than that and for NaN. Above, e^(-chi2/2) underflows and the result is too small.
[[nodiscard]] inline double chi_squared_probability(double chi2, int ndf) {
  if (!(chi2 >= 0.0) || ndf < 1) return std::numeric_limits<double>::quiet_NaN();
  if (std::isinf(chi2)) return 0.0;
  const double x = 0.5 * chi2;
  const bool odd = ndf % 2 == 1;
  double probability = odd ? std::erfc(std::sqrt(x)) : 0.0;
  // Terms x^a e^-x / Gamma(a + 1) for a = 1/2, 3/2, ... or 0, 1, ...
  double a = odd ? 0.5 : 0.0;
  double term = odd ? 2.0 * std::sqrt(x / constants::pi) * std::exp(-x) : std::exp(-x);
  for (; a + 0.75 < 0.5 * ndf; a += 1.0) {
    probability += term;
    term *= x / (a + 1.0);
  }
  return probability < 1.0 ? probability : 1.0;
}

}  // namespace scifi
