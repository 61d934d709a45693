// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <scifi/core/constants.hpp>
#include <scifi/study/sample.hpp>

namespace scifi::study {

/// How far p-values are from being uniform on 0 .. 1.
struct flatness {
  std::size_t count = 0;
  double distance = std::numeric_limits<double>::quiet_NaN();     ///< largest distance between their cumulative distribution and the diagonal
  double probability = std::numeric_limits<double>::quiet_NaN();  ///< of so large a distance or a larger one, were they uniform
};

/// Survival function of Kolmogorov's distribution, Q(l) = 2 sum_j (-1)^(j-1) exp(-2 j^2 l^2); below l = 1.18 the series that converges faster there,
/// 1 - sqrt(2 pi)/l sum_j exp(-(2j-1)^2 pi^2/(8 l^2)) (Marsaglia, Tsang and Wang, J. Stat. Soft. 8 (2003) 18). l >= 0.
[[nodiscard]] inline double kolmogorov_survival(double l) {
  constexpr double slower_below = 1.18;
  if (!(l > 0.0)) return 1.0;
  double sum = 0.0;
  if (l < slower_below) {
    for (int j = 1; j <= 7; j += 2) sum += std::exp(-j * j * constants::pi * constants::pi / (8.0 * l * l));
    return 1.0 - std::sqrt(2.0 * constants::pi) / l * sum;
  }
  for (int j = 1; j <= 4; ++j) sum += (j % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * j * j * l * l);
  return sum;
}

/// One-sample Kolmogorov-Smirnov test against the uniform distribution. Values in 0 .. 1; both numbers are NaN where one is. The probability is that of Kolmogorov's limit at
/// l = (sqrt(n) + 0.12 + 0.11/sqrt(n)) D (M. A. Stephens, J. R. Stat. Soc. B 32 (1970) 115), good from n = 4 on.
[[nodiscard]] inline flatness flatness_of(const sample& probabilities) {
  flatness out;
  out.count = probabilities.size();
  if (out.count == 0) return out;
  const std::vector<double> sorted = probabilities.sorted();
  if (std::isnan(sorted.back())) return out;
  const double n = static_cast<double>(out.count);
  double distance = 0.0;
  double below = 0.0;
  for (const double p : sorted) {
    distance = std::max({distance, p - below / n, (below + 1.0) / n - p});
    below += 1.0;
  }
  out.distance = distance;
  const double root = std::sqrt(n);
  out.probability = kolmogorov_survival((root + 0.12 + 0.11 / root) * distance);
  return out;
}

}  // namespace scifi::study
