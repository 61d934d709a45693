// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <scifi/event/adc_line.hpp>
#include <scifi/readout_to_digit/readout.hpp>

namespace scifi {

/// The calibration of every read-out channel that has one.
class readout_calibration {
 public:
  explicit readout_calibration(const readout_layout& layout = {}) : layout_(layout), lines_(layout.size()) {}

  /// False, and nothing changed, where the layout has no such channel or the line is not valid.
  [[nodiscard]] bool set(const readout_channel& r, const adc_line& line) {
    const std::optional<std::size_t> at = layout_.index(r);
    if (!at || !line.valid()) return false;
    calibrated_ += lines_[*at] ? 0 : 1;
    lines_[*at] = line;
    return true;
  }

  /// Nothing for a channel without a calibration. Constant time.
  [[nodiscard]] std::optional<adc_line> of(const readout_channel& r) const {
    const std::optional<std::size_t> at = layout_.index(r);
    return at ? lines_[*at] : std::nullopt;
  }

  /// Number of calibrated channels.
  [[nodiscard]] std::size_t size() const { return calibrated_; }

 private:
  readout_layout layout_;
  std::vector<std::optional<adc_line>> lines_;
  std::size_t calibrated_ = 0;
};

}  // namespace scifi
