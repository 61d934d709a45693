// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace scifi {

/// The calibration of one channel, a straight line between light and ADC counts: counts = gain npe + pedestal.
struct adc_line {
  double gain = 0.0;      ///< counts per photo-electron, above zero
  double pedestal = 0.0;  ///< counts without light, not negative

  /// Can be used: gain above zero, pedestal not negative, both finite.
  [[nodiscard]] bool valid() const { return gain > 0.0 && pedestal >= 0.0 && std::isfinite(gain) && std::isfinite(pedestal); }
  /// Light that counts mean, photo-electrons; negative below the pedestal. Needs `valid()`.
  [[nodiscard]] double npe(int counts) const { return (counts - pedestal) / gain; }
  /// Whole counts nearest to what light (photo-electrons) makes, kept within 0 .. largest. Needs `valid()`.
  [[nodiscard]] int counts(double npe, int largest) const {
    return static_cast<int>(std::clamp(std::round(gain * npe + pedestal), 0.0, static_cast<double>(largest)));
  }
};

}  // namespace scifi
