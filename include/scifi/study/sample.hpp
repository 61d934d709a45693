// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace scifi::study {

/// All values of one quantity. Samples filled apart are merged with +=, in any order: what is computed of them does not depend on it.
class sample {
 public:
  void add(double value) { values_.push_back(value); }
  sample& operator+=(const sample& other) {
    for (std::size_t i = 0, n = other.size(); i < n; ++i) values_.push_back(other.values_[i]);  // other may be *this
    return *this;
  }
  [[nodiscard]] std::size_t size() const { return values_.size(); }
  [[nodiscard]] std::span<const double> values() const { return values_; }
  /// In rising order, NaN last.
  [[nodiscard]] std::vector<double> sorted() const {
    std::vector<double> out = values_;
    std::sort(out.begin(), out.end(), [](double a, double b) { return a < b || (std::isnan(b) && !std::isnan(a)); });
    return out;
  }

 private:
  std::vector<double> values_;
};

/// Quantile of sorted values, linear between order statistics: the place of the q-th of n is q (n - 1). NaN of none, and for q outside 0 .. 1.
[[nodiscard]] inline double quantile(std::span<const double> sorted, double q) {
  if (sorted.empty() || !(q >= 0.0 && q <= 1.0)) return std::numeric_limits<double>::quiet_NaN();
  const double place = q * static_cast<double>(sorted.size() - 1);
  const auto i = static_cast<std::size_t>(place);
  const std::size_t next = std::min(i + 1, sorted.size() - 1);
  return sorted[i] + (sorted[next] - sorted[i]) * (place - static_cast<double>(i));
}

/// A distribution in few numbers, of which outliers change only the mean and the tail. All NaN of no value, and where one is NaN.
struct summary {
  std::size_t count = 0;
  double mean = std::numeric_limits<double>::quiet_NaN();
  double median = std::numeric_limits<double>::quiet_NaN();
  double median_error = std::numeric_limits<double>::quiet_NaN();  ///< standard error for a normal core
  double spread = std::numeric_limits<double>::quiet_NaN();        ///< half the width of the central 68.27 %
  double spread_error = std::numeric_limits<double>::quiet_NaN();  ///< standard error for a normal core
  double tail = std::numeric_limits<double>::quiet_NaN();          ///< share further than five spreads from zero
};

/// Standard errors: of the median sqrt(pi/2) sigma/sqrt(n); of half the distance of the quantiles p and 1 - p of a normal distribution
/// sqrt(p (1 - 2p)/2)/phi(1) = 0.962 sigma/sqrt(n) with p = 0.1587 (both from the covariance of order statistics, Kendall and Stuart, vol. 1, 10.10).
[[nodiscard]] inline summary summarise(const sample& values) {
  summary out;
  out.count = values.size();
  if (out.count == 0) return out;
  const std::vector<double> sorted = values.sorted();
  if (std::isnan(sorted.back())) return out;
  const double n = static_cast<double>(out.count);
  double sum = 0.0;
  for (const double x : sorted) sum += x;
  out.mean = sum / n;
  constexpr double one_sigma_below = 0.15865;
  constexpr double one_sigma_above = 0.84135;
  out.median = quantile(sorted, 0.5);
  out.spread = 0.5 * (quantile(sorted, one_sigma_above) - quantile(sorted, one_sigma_below));
  constexpr double error_of_median = 1.2533141373;
  constexpr double error_of_spread = 0.9617;
  out.median_error = error_of_median * out.spread / std::sqrt(n);
  out.spread_error = error_of_spread * out.spread / std::sqrt(n);
  constexpr double far = 5.0;
  out.tail = static_cast<double>(std::count_if(sorted.begin(), sorted.end(), [&](double x) { return std::abs(x) > far * out.spread; })) / n;
  return out;
}

}  // namespace scifi::study
