// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <scifi/core/random.hpp>
#include <scifi/event/adc_line.hpp>
#include <scifi/geometry/channel_id.hpp>

namespace scifi {

/// A calibration per channel, drawn from Gaussians and kept above a fifth of their mean: a function of seed and channel alone, not stored.
/// Defaults: gains and pedestals like those of the MICE photon counters.
struct drawn_calibration {
  std::uint64_t seed = 0;
  adc_line mean{9.5, 26.0};
  adc_line width{0.6, 1.2};

  [[nodiscard]] adc_line operator()(const channel_id& id) const {
    constexpr std::uint32_t calibration_stage = 255;
    random_stream random(seed, 0, calibration_stage, static_cast<std::uint32_t>(tspc(id)));
    const auto draw = [&random](double centre, double spread) { return std::max(centre + spread * random.normal(), 0.2 * centre); };
    const double gain = draw(mean.gain, width.gain);
    return {gain, draw(mean.pedestal, width.pedestal)};
  }
};

/// The same calibration for every channel.
struct uniform_calibration {
  adc_line value{10.0, 28.0};

  [[nodiscard]] adc_line operator()(const channel_id&) const { return value; }
};

/// What the ADC makes of a channel: counts, and the light that they mean.
struct adc_reading {
  int counts = 0;
  double npe = 0.0;
};

/// The photon counter and its ADC.
struct adc_response {
  double resolution = 1.0;  ///< Gaussian response of the photon counter, photo-electrons
  int largest_count = 255;  ///< 8 bits

  /// Reading of `photo_electrons` > 0: rounded down, smeared, turned into counts, rounded down, limited to 0 .. largest_count, and back with the same calibration.
  /// Less than one photo-electron, or NaN, is none and gives npe = 0 exactly; so does a channel whose calibration is not valid.
  [[nodiscard]] adc_reading read(double photo_electrons, const adc_line& calibration, random_stream& random) const {
    if (!calibration.valid()) return {};
    const double whole = std::floor(photo_electrons);
    if (!(whole > 0.0)) return {limited(calibration.pedestal), 0.0};
    const double smeared = whole + resolution * random.normal();
    const int counts = limited(std::floor(smeared * calibration.gain + calibration.pedestal));
    return {counts, calibration.npe(counts)};
  }

 private:
  [[nodiscard]] int limited(double counts) const { return static_cast<int>(std::fmax(std::fmin(counts, largest_count), 0.0)); }  // NaN is the largest
};

}  // namespace scifi
