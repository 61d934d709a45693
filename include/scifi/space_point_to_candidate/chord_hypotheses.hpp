// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <scifi/arc/arc_fit.hpp>
#include <scifi/arc/chord_turn.hpp>
#include <scifi/core/constants.hpp>
#include <scifi/core/inline_vector.hpp>
#include <scifi/space_point_to_candidate/station_scattering.hpp>
#include <scifi/space_point_to_candidate/track_finder_options.hpp>

namespace scifi {

/// A curvature to start a fit from, and how many Gauss-Newton steps bring it home.
struct curvature_hypothesis {
  double curvature = 0.0;  ///< rad/mm
  int iterations = 1;
};

/// The curvatures that three points at given z allow.
///
/// On a helix the chord over dz is slope x sin(w dz/2)/(w/2), turned by half the angle. So the second chord is turned against the first by w (z3 - z1)/2, modulo
/// a turn, and the ratio of their lengths must be that of the sines, whose signs count: each turn is a hypothesis that the lengths keep or reject. Where a chord is short
/// against its errors the angle says nothing, and the typical curvature of either sign is tried.
class chord_hypotheses {
 public:
  using list = inline_vector<curvature_hypothesis, 8>;

  /// `first` and `middle` are the indices of the first two stations, for their scattering; `gate` is the largest squared deviation of the length.
  chord_hypotheses(const track_finder_options& options, const station_scattering& scattering, std::size_t first, std::size_t middle, const chord_turn& turn, double gate)
      : options_(options), scattering_(scattering), middle_(middle), turn_(turn), gate_(gate), largest_(std::abs(options.field) / options.smallest_pz) {
    const double slowest = 1.0 / (options.prior.typical + options.prior.spread);
    widest_scatter_ = scattering.slope_variance(middle, slowest, 0.0) * square(turn.step2());
    angle_scatter_ = scattering.slope_variance(first, expected_momentum(options, 0.0, 0.0), 0.0) * square(turn.step1() + turn.step2());
  }

  [[nodiscard]] list operator()(const arc_point& a, const arc_point& b, const arc_point& c) const {
    list out;
    const planar<double> first = b.position - a.position;
    const planar<double> second = c.position - b.position;
    const double length1 = std::sqrt(norm(first));
    const double length2 = std::sqrt(norm(second));
    // Before any angle is taken: a length that no curvature explains.
    const double slack = std::sqrt(gate_ * (blur(a, b, c, turn_.longest_ratio()) + widest_scatter_));
    if (length2 < turn_.shortest_ratio() * length1 - slack || length2 > turn_.longest_ratio() * length1 + slack) return out;

    const double half = turn_.half();
    const planar<double> product = conjugate(first) * second;
    const double angle = -std::atan2(product.y, product.x);  // w half, modulo a turn; half a turn off where one of the chords has passed a whole turn
    constexpr double most_turns = 100.0;
    const int turns = static_cast<int>(std::fmax(std::fmin(std::ceil(largest_ * half / (2.0 * constants::pi)), most_turns), 0.0));
    const int step = largest_ * std::max(turn_.step1(), turn_.step2()) < 2.0 * constants::pi ? 2 : 1;
    for (int n = -2 * turns; n <= 2 * turns; n += step) {
      const double w = (angle + n * constants::pi) / half;
      if (std::abs(w) > largest_) continue;
      const double signed_ratio = turn_.ratio(w);
      if ((signed_ratio < 0.0) != (n % 2 != 0)) continue;
      const double ratio = std::abs(signed_ratio);
      const double scatter = scattering_.slope_variance(middle_, expected_momentum(options_, w, 0.0), 0.0) * square(turn_.step2());
      if (square(length2 - ratio * length1) < gate_ * (blur(a, b, c, ratio) + scatter)) out.push_back({w, 1});
    }
    constexpr double clear = 16.0;  // a chord of four standard deviations has a direction
    const double error = a.variance + b.variance + angle_scatter_;
    if (norm(first) < clear * error || norm(second) < clear * error)
      for (const double sign : {1.0, -1.0}) out.push_back({sign * options_.prior.typical * options_.field, 3});
    return out;
  }

 private:
  /// Variance of (second length - ratio x first length) from the errors of the points.
  [[nodiscard]] static double blur(const arc_point& a, const arc_point& b, const arc_point& c, double ratio) {
    return a.variance * square(ratio) + b.variance * square(1.0 + ratio) + c.variance;
  }

  const track_finder_options& options_;
  const station_scattering& scattering_;
  std::size_t middle_;
  const chord_turn& turn_;
  double gate_;
  double largest_;         // curvature
  double widest_scatter_;  // mm^2, of the second chord
  double angle_scatter_;   // mm^2
};

}  // namespace scifi
