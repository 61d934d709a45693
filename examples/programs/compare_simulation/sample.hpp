// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace scifi::compare {

/// A number with its statistical error.
struct figure {
  double value = 0.0;
  double error = 0.0;
};

/// Values of one quantity, kept in groups of independent events: a figure's error comes from its spread over the groups.
class sample {
 public:
  static constexpr std::size_t groups = 25;

  void add(long event, double value) { values_[static_cast<std::size_t>(event) % groups].push_back(value); }
  [[nodiscard]] std::size_t size() const {
    std::size_t n = 0;
    for (const auto& group : values_) n += group.size();
    return n;
  }

  /// statistic(values in order) over all values; its error from the same over each group.
  template <class Statistic>
  [[nodiscard]] figure of(const Statistic& statistic) const {
    std::vector<double> all;
    double sum = 0.0, squares = 0.0;
    for (std::vector<double> group : values_) {
      all.insert(all.end(), group.begin(), group.end());
      std::sort(group.begin(), group.end());
      const double value = statistic(group);
      sum += value;
      squares += value * value;
    }
    std::sort(all.begin(), all.end());
    constexpr double n = groups;
    const double variance = std::max(squares / n - sum / n * (sum / n), 0.0) * n / (n - 1.0);
    return {statistic(all), std::sqrt(variance / n)};
  }

 private:
  std::array<std::vector<double>, groups> values_;
};

/// Statistics of values in order; zero of none.
[[nodiscard]] inline double mean(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double value : x) sum += value;
  return x.empty() ? 0.0 : sum / static_cast<double>(x.size());
}

[[nodiscard]] inline double quantile(const std::vector<double>& x, double share) {
  return x.empty() ? 0.0 : x[std::min(static_cast<std::size_t>(share * static_cast<double>(x.size())), x.size() - 1)];
}

[[nodiscard]] inline double median(const std::vector<double>& x) { return quantile(x, 0.5); }

/// Half the width of the central 68.27 %: one standard deviation of a Gaussian.
[[nodiscard]] inline double core_width(const std::vector<double>& x) { return 0.5 * (quantile(x, 0.84135) - quantile(x, 0.15865)); }

[[nodiscard]] inline double standard_deviation(const std::vector<double>& x) {
  const double centre = mean(x);
  double sum = 0.0;
  for (const double value : x) sum += (value - centre) * (value - centre);
  return x.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(x.size()));
}

/// Share of values further than `limit` from zero.
[[nodiscard]] inline double share_beyond(const std::vector<double>& x, double limit) {
  const auto outside = std::count_if(x.begin(), x.end(), [limit](double value) { return std::abs(value) > limit; });
  return x.empty() ? 0.0 : static_cast<double>(outside) / static_cast<double>(x.size());
}

/// Share of values equal to `value`.
[[nodiscard]] inline double share_equal(const std::vector<double>& x, double value) {
  const auto [first, last] = std::equal_range(x.begin(), x.end(), value);
  return x.empty() ? 0.0 : static_cast<double>(last - first) / static_cast<double>(x.size());
}

}  // namespace scifi::compare
