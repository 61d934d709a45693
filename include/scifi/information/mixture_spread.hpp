// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <limits>
#include <ranges>

namespace scifi {

/// Half the width of the central 68.27 % of errors that are normal with mean zero, each with its own standard deviation: what such a spread, measured over
/// many tracks, would be if each reached its bound. Unit of the sigmas; NaN of none, or where fewer than 68.27 % of the sigmas are finite.
template <std::ranges::forward_range Sigmas>
[[nodiscard]] double mixture_spread(const Sigmas& sigmas) {
  constexpr double wanted = 0.682689492137086;  // erf(1/sqrt(2))
  double largest = 0.0;
  double number = 0.0;
  double finite = 0.0;
  for (const double sigma : sigmas) {
    number += 1.0;
    if (!std::isfinite(sigma)) continue;
    finite += 1.0;
    largest = sigma > largest ? sigma : largest;
  }
  if (!(finite > wanted * number)) return std::numeric_limits<double>::quiet_NaN();
  const auto share_within = [&](double width) {
    double sum = 0.0;
    for (const double sigma : sigmas)
      if (std::isfinite(sigma)) sum += sigma > 0.0 ? std::erf(width / (sigma * std::sqrt(2.0))) : 1.0;
    return sum / number;
  };
  double low = 0.0;
  double high = largest;
  while (share_within(high) < wanted) high *= 2.0;
  constexpr int halvings = 60;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    (share_within(middle) < wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace scifi
