// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <scifi/core/constants.hpp>
#include <scifi/core/philox.hpp>

namespace scifi {

/// Random numbers that belong to (seed, event, stage, index) and to nothing else: the same in any thread and in any order of the events.
///
/// The key of Philox4x32-10 is the seed, its counter holds event, stage, index and the number of the block. A stream gives 2^33 uniform numbers.
/// The distributions are written out here since those of the standard library differ between its implementations.
class random_stream {
 public:
  /// stage < 256 tells the steps of a simulation apart, index < 2^24 the particles, channels ... within a step.
  constexpr random_stream(std::uint64_t seed, std::uint64_t event, std::uint32_t stage, std::uint32_t index = 0)
      : key_{low(seed), high(seed)}, counter_{0, stage << 24 | (index & 0xFFFFFFu), low(event), high(event)} {}

  /// 64 random bits.
  [[nodiscard]] constexpr std::uint64_t bits() {
    if (next_ == words_.size()) {
      words_ = philox4x32_10(counter_, key_);
      ++counter_[0];
      next_ = 0;
    }
    const std::uint64_t first = words_[next_];
    const std::uint64_t second = words_[next_ + 1];
    next_ += 2;
    return first << 32 | second;
  }

  /// Uniform in the open interval (0, 1), in steps of 2^-52; never 0 and never 1, so its logarithm is finite.
  [[nodiscard]] constexpr double uniform() { return (static_cast<double>(bits() >> 12) + 0.5) * 0x1p-52; }

  /// Uniform between two bounds.
  [[nodiscard]] constexpr double uniform(double from, double to) { return from + (to - from) * uniform(); }

  /// Normal with mean 0 and variance 1: Box and Muller, Ann. Math. Stat. 29 (1958) 610.
  [[nodiscard]] double normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    const double angle = 2.0 * constants::pi * uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
  }

  /// Exponential with mean 1.
  [[nodiscard]] double exponential() { return -std::log(uniform()); }

  /// Poisson with this mean >= 0, by inversion: the time grows with the mean. Zero for a mean of zero or below, or NaN. Above a million a rounded Gaussian of the
  /// same mean and variance, which differs by a thousandth of its width at most; the largest int where that is less.
  [[nodiscard]] int poisson(double mean) {
    constexpr double many = 1.0e6;
    if (mean > many) {
      constexpr double largest = std::numeric_limits<int>::max();
      return static_cast<int>(std::fmin(std::round(mean + std::sqrt(mean) * normal()), largest));
    }
    // A sum of Poisson numbers is one: pieces keep exp(-mean) well away from underflow.
    constexpr double piece = 16.0;
    int count = 0;
    for (; mean > piece; mean -= piece) count += small_poisson(piece);
    return mean > 0.0 ? count + small_poisson(mean) : count;
  }

  /// Poisson under the condition that it is not zero, for a mean > 0. One where the mean is so small that no more can be.
  [[nodiscard]] int poisson_above_zero(double mean) {
    constexpr double never_zero = 100.0;
    if (mean > never_zero) return poisson(mean);
    const double probability_of_zero = std::exp(-mean);
    return std::max(poisson_quantile(mean, uniform(probability_of_zero, 1.0)), 1);
  }

 private:
  [[nodiscard]] static constexpr std::uint32_t low(std::uint64_t x) { return static_cast<std::uint32_t>(x); }
  [[nodiscard]] static constexpr std::uint32_t high(std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); }

  [[nodiscard]] int small_poisson(double mean) { return poisson_quantile(mean, uniform()); }

  /// Smallest n whose cumulative probability exceeds u; bounded where rounding leaves the sum of all terms below u.
  [[nodiscard]] static int poisson_quantile(double mean, double u) {
    constexpr int largest = 1000;
    double term = std::exp(-mean);
    double sum = term;
    int n = 0;
    while (u > sum && n < largest && term > 0.0) {
      ++n;
      term *= mean / n;
      sum += term;
    }
    return n;
  }

  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> counter_;
  std::array<std::uint32_t, 4> words_{};
  std::size_t next_ = 4;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace scifi
