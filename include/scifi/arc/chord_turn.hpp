// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <scifi/core/constants.hpp>
#include <scifi/core/planar.hpp>

namespace scifi {

/// How a helix goes on from one chord to the next between three stations: over dz the chord is slope x sin(w dz/2)/(w/2), turned by half the angle, so
///   second chord = F(w) first chord,  F(w) = sin(w dz2/2)/sin(w dz1/2) e^{-i w (dz1 + dz2)/2},
/// dz2/dz1 for a straight line. F is tabulated, within 2e-4 of itself, up to `largest()`, where the longer step is half a turn.
class chord_turn {
 public:
  chord_turn() = default;
  /// Steps in mm, above zero; `most`: largest curvature, rad/mm.
  chord_turn(double step1, double step2, double most) : step1_(step1), step2_(step2), shortest_ratio_(step2 / step1), longest_ratio_(step2 / step1) {
    const double half_turn = constants::pi / std::max(step1, step2);
    largest_ = std::min(most, half_turn);
    spacing_ = std::max(largest_, 1e-3 * half_turn) / (nodes - 2);
    for (int i = 0; i < nodes; ++i) {
      const double w = i * spacing_;
      const double length = ratio(w);
      at_[static_cast<std::size_t>(i)] = {length * std::cos(w * half()), -length * std::sin(w * half())};
    }
    constexpr int steps = 32;
    for (int i = 1; i <= steps; ++i) {
      const double length = std::abs(ratio(most * i / steps));
      shortest_ratio_ = std::min(shortest_ratio_, length);
      longest_ratio_ = std::max(longest_ratio_, length);
    }
  }

  /// F and its derivative in w; |w| at most `largest()`.
  struct value {
    planar<double> factor, derivative;
  };
  [[nodiscard]] value operator()(double w) const {
    const double place = std::min(std::abs(w), largest_) / spacing_;
    const auto i = static_cast<std::size_t>(place);
    const planar<double> step = at_[i + 1] - at_[i];
    const planar<double> f = at_[i] + (place - static_cast<double>(i)) * step;
    const planar<double> slope = (1.0 / spacing_) * step;
    return w < 0.0 ? value{conjugate(f), {-slope.x, slope.y}} : value{f, slope};
  }
  /// rad/mm
  [[nodiscard]] double largest() const { return largest_; }
  /// Angle between the chords per curvature, (dz1 + dz2)/2, mm.
  [[nodiscard]] double half() const { return 0.5 * (step1_ + step2_); }
  [[nodiscard]] double step1() const { return step1_; }  ///< mm
  [[nodiscard]] double step2() const { return step2_; }  ///< mm
  /// Ratio of the lengths of the chords at any curvature, negative where one of them has passed a whole turn.
  [[nodiscard]] double ratio(double w) const { return chord(w, step2_) / chord(w, step1_); }
  [[nodiscard]] double shortest_ratio() const { return shortest_ratio_; }  ///< its least size up to `most`
  [[nodiscard]] double longest_ratio() const { return longest_ratio_; }    ///< its largest

 private:
  static constexpr int nodes = 98;
  [[nodiscard]] static double chord(double w, double dz) {
    const double x = 0.5 * w * dz;
    return std::abs(x) < 1e-6 ? dz : dz * std::sin(x) / x;
  }
  double step1_ = 1.0, step2_ = 1.0;
  double shortest_ratio_ = 1.0, longest_ratio_ = 1.0;
  double largest_ = 0.0;
  double spacing_ = 1.0;
  std::array<planar<double>, nodes> at_{};
};

}  // namespace scifi
