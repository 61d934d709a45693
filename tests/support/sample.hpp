// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace scifi::test {

/// Numbers of one kind, and what describes their distribution.
class sample {
 public:
  void add(double x) { values_.push_back(x); }
  [[nodiscard]] std::size_t size() const { return values_.size(); }

  [[nodiscard]] double mean() const {
    double sum = 0.0;
    for (const double x : values_) sum += x;
    return sum / static_cast<double>(size());
  }
  /// About the mean.
  [[nodiscard]] double standard_deviation() const {
    const double centre = mean();
    double sum = 0.0;
    for (const double x : values_) sum += (x - centre) * (x - centre);
    return std::sqrt(sum / static_cast<double>(size()));
  }
  /// Linear between the order statistics; NaN of nothing.
  [[nodiscard]] double quantile(double q) const {
    if (values_.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::vector<double> sorted = values_;
    std::sort(sorted.begin(), sorted.end());
    const double place = q * static_cast<double>(size() - 1);
    const auto i = static_cast<std::size_t>(place);
    const std::size_t j = std::min(i + 1, size() - 1);
    return sorted[i] + (sorted[j] - sorted[i]) * (place - static_cast<double>(i));
  }
  [[nodiscard]] double median() const { return quantile(0.5); }
  /// Half the width of the central 68.27 %: the standard deviation of a Gaussian core.
  [[nodiscard]] double spread() const { return 0.5 * (quantile(0.84135) - quantile(0.15865)); }
  /// Standard error of the mean and, 1.25 times that, of the median of a Gaussian.
  [[nodiscard]] double error_of_mean() const { return standard_deviation() / std::sqrt(static_cast<double>(size())); }
  /// Relative standard error of `spread` of a Gaussian: sqrt(q (1 - 2 q)/2)/(z phi(z)) with q = 0.159 and phi(1) = 0.242, over sqrt(n).
  [[nodiscard]] double relative_error_of_spread() const { return 0.96 / std::sqrt(static_cast<double>(size())); }

 private:
  std::vector<double> values_;
};

/// Standard error of an efficiency seen as found of expected.
[[nodiscard]] inline double error_of_share(double share, long expected) { return std::sqrt(std::max(share * (1.0 - share), 1.0 / static_cast<double>(expected)) / static_cast<double>(expected)); }

}  // namespace scifi::test
