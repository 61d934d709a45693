// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/core/random.hpp>

namespace scifi {

/// Thermal photo-electrons: Poisson in every channel, on average -ln(1 - rate), so that `rate` is the chance of one or more.
/// The rate is that of one channel and one event, 0 <= rate < 1; zero is no noise, and so is a rate out of that range.
struct thermal_noise {
  double rate = 0.015;

  /// Calls visit(channel, photo_electrons) for each channel of 0 .. channels - 1 that has any, in order.
  /// Jumps from one noisy channel to the next (their distance is geometric), so the time goes with the noisy ones.
  template <class Visit>
  void for_each(int channels, random_stream& random, Visit&& visit) const {
    if (!(rate > 0.0 && rate < 1.0)) return;
    const double log_quiet = std::log1p(-rate);
    double channel = -1.0;
    while (true) {
      channel += 1.0 + std::floor(std::log(random.uniform()) / log_quiet);
      if (!(channel < channels)) return;
      visit(static_cast<int>(channel), random.poisson_above_zero(-log_quiet));
    }
  }
};

}  // namespace scifi
