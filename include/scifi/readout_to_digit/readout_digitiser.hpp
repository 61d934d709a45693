// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <scifi/event/raw_digit.hpp>
#include <scifi/readout_to_digit/bad_channels.hpp>
#include <scifi/readout_to_digit/cabling_map.hpp>
#include <scifi/readout_to_digit/calibration.hpp>
#include <scifi/readout_to_digit/readout.hpp>

namespace scifi {

/// What became of raw counts; the first reason that applies counts, in this order.
struct readout_tally {
  long not_cabled = 0;       ///< no detector channel is connected
  long bad = 0;              ///< listed as a bad channel
  long not_calibrated = 0;   ///< no gain and pedestal
  long below_threshold = 0;  ///< less light than asked for
  long digits = 0;

  readout_tally& operator+=(const readout_tally& more) {
    not_cabled += more.not_cabled;
    bad += more.bad;
    not_calibrated += more.not_calibrated;
    below_threshold += more.below_threshold;
    digits += more.digits;
    return *this;
  }
  /// Raw counts altogether.
  [[nodiscard]] long counts() const { return not_cabled + bad + not_calibrated + below_threshold + digits; }
};

/// From the raw counts of an event to its digits, npe = (adc - pedestal) / gain, and back. Const: one for all threads.
class readout_digitiser {
 public:
  /// `min_npe`: digits with less light are not kept, photo-electrons; not negative.
  readout_digitiser(cabling_map cabling, readout_calibration calibration, bad_channels bad, double min_npe = 2.0)
      : cabling_(std::move(cabling)), calibration_(std::move(calibration)), bad_(std::move(bad)), min_npe_(min_npe) {}

  /// Replaces `out` by the digits in order of their channels and tells what became of the counts. A read-out channel is given once an
  /// event. The memory of `out` is reused.
  readout_tally operator()(std::span<const raw_count> counts, std::vector<raw_digit>& out) const {
    readout_tally tally;
    out.clear();
    for (const raw_count& raw : counts) {
      const std::optional<channel_id> id = cabling_.channel_of(raw.from);
      if (!id) {
        ++tally.not_cabled;
        continue;
      }
      if (bad_.contains(raw.from)) {
        ++tally.bad;
        continue;
      }
      const std::optional<adc_line> line = calibration_.of(raw.from);
      if (!line) {
        ++tally.not_calibrated;
        continue;
      }
      const double npe = line->npe(raw.adc);
      if (!(npe >= min_npe_)) {
        ++tally.below_threshold;
        continue;
      }
      ++tally.digits;
      out.push_back({*id, raw.adc, npe});
    }
    std::sort(out.begin(), out.end(), [](const raw_digit& a, const raw_digit& b) { return a.id < b.id; });
    return tally;
  }

  /// The counts that a digit comes from, to the nearest whole one, limited to what the ADC can say: its light is found again to half a count.
  /// Nothing where the digit could not have come through: its channel is not cabled, bad or not calibrated.
  [[nodiscard]] std::optional<raw_count> raw(const digit& d) const {
    const std::optional<readout_channel> from = cabling_.cable_of(d.id);
    if (!from || bad_.contains(*from)) return std::nullopt;
    const std::optional<adc_line> line = calibration_.of(*from);
    if (!line) return std::nullopt;
    return raw_count{*from, line->counts(d.npe, cabling_.layout().largest_count)};
  }

 private:
  cabling_map cabling_;
  readout_calibration calibration_;
  bad_channels bad_;
  double min_npe_;
};

}  // namespace scifi
