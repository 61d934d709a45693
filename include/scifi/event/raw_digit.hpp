// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/event/digit.hpp>

namespace scifi {

/// A digit with the ADC counts that it was made of, simulated or read out.
struct raw_digit {
  channel_id id;
  int adc = 0;
  double npe = 0.0;

  /// What the reconstruction sees of it.
  [[nodiscard]] digit seen() const { return {id, npe}; }
};

}  // namespace scifi
