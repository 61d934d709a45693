// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace scifi::alignment {

/// By how much the chi2 of tracks are too large, from their median: outliers do not move it. Mergeable, of fixed size.
///
/// While a detector is not aligned all chi2 are too large together; a cut on the probability of chi2 / scale then takes out those that stand out.
class chi2_scale {
 public:
  /// Adds a track. The median of chi2 is ndf (1 - 2/(9 ndf))^3 (Wilson and Hilferty, PNAS 17 (1931) 684), to 2 % from ndf = 2 on.
  void add(double chi2, int ndf) {
    if (!(chi2 >= 0.0) || ndf < 1) return;
    const double cube_root = 1.0 - 2.0 / (9.0 * ndf);
    const double ratio = chi2 / (ndf * cube_root * cube_root * cube_root);
    const double place = (std::log(std::max(ratio, smallest)) - std::log(smallest)) / width;
    ++counts_[static_cast<std::size_t>(std::min(place, static_cast<double>(bins - 1)))];
    ++total_;
  }
  chi2_scale& operator+=(const chi2_scale& more) {
    for (std::size_t i = 0; i < bins; ++i) counts_[i] += more.counts_[i];
    total_ += more.total_;
    return *this;
  }

  /// Median of chi2 over that expected, to 1 %, between 1e-3 and 1e6; 1 without tracks.
  [[nodiscard]] double median() const {
    long below = 0;
    for (std::size_t i = 0; i < bins; ++i) {
      if (2 * (below + counts_[i]) >= total_ && counts_[i] > 0) {
        const double share = (0.5 * static_cast<double>(total_) - static_cast<double>(below)) / static_cast<double>(counts_[i]);
        return smallest * std::exp(width * (static_cast<double>(i) + share));
      }
      below += counts_[i];
    }
    return 1.0;
  }
  [[nodiscard]] long size() const { return total_; }

 private:
  static constexpr std::size_t bins = 1024;
  static constexpr double smallest = 1.0e-3;
  static constexpr double width = 20.723265836946414 / bins;  // ln(1e9): from 1e-3 to 1e6
  std::array<long, bins> counts_{};
  long total_ = 0;
};

}  // namespace scifi::alignment
