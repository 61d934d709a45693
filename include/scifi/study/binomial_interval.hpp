// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace scifi::study {

/// A range of probabilities.
struct probability_interval {
  double low = 0.0;
  double high = 1.0;
};

/// Interval for a probability that was seen as `found` of `expected` trials; `sigmas` normal standard deviations wide on either side (1: 68.27 %).
///
/// E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209: (p + z^2/2n +- z sqrt(p (1 - p)/n + z^2/4n^2))/(1 + z^2/n). Sensible for 0 and for all found, and never
/// outside 0 .. 1. 0 <= found <= expected; without a trial it is 0 .. 1.
[[nodiscard]] inline probability_interval wilson_interval(double found, double expected, double sigmas = 1.0) {
  if (!(expected > 0.0)) return {};
  const double share = found / expected;
  const double squared = sigmas * sigmas / expected;
  const double centre = share + 0.5 * squared;
  const double half = std::sqrt(squared * (share * (1.0 - share) + 0.25 * squared));
  return {std::max(0.0, (centre - half) / (1.0 + squared)), std::min(1.0, (centre + half) / (1.0 + squared))};
}

}  // namespace scifi::study
