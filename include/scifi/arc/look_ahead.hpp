// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/arc/arc_fit.hpp>
#include <scifi/arc/chord_turn.hpp>
#include <scifi/core/constants.hpp>
#include <scifi/core/planar.hpp>
#include <scifi/core/scalar.hpp>

namespace scifi {

/// The first and the last chord of the points chosen. The next point is expected where the last chord goes on with the curvature, which is known from the angle
/// between the two.
struct chord_pair {
  const arc_point &first, &second;  ///< ends of the first chord
  const arc_point &before, &last;   ///< of the last; `before` may be `second`
  bool joined = true;               ///< that it is
  double kinks = 0.0;               ///< variance of the slope from the scattering between the chords
  double last_kink = 0.0;           ///< and in the last station

  [[nodiscard]] planar<double> first_chord() const { return second.position - first.position; }
  [[nodiscard]] planar<double> last_chord() const { return last.position - before.position; }
  /// Distance of the middles of the chords in z, mm.
  [[nodiscard]] double lever() const { return 0.5 * (last.z + before.z - second.z - first.z); }
  /// Curvature by the angle between the chords, next to `near`.
  [[nodiscard]] double curvature(double near) const {
    const planar<double> product = conjugate(first_chord()) * last_chord();
    const double off = -std::atan2(product.y, product.x) - near * lever();
    return near + (off - 2.0 * constants::pi * std::round(off / (2.0 * constants::pi))) / lever();
  }
};

/// Where a track is expected at the next station, without a fit.
class outlook {
 public:
  /// With this curvature. `next`: from the last chord to the one ahead; |curvature| at most `next.largest()`. The variance is that of the errors of the points, of the
  /// curvature that they give and of scattering; along the direction in which the curvature moves the place, those that may add up are added before they are squared.
  outlook(const chord_pair& seen, const chord_turn& next, double curvature) {
    const chord_turn::value f = next(curvature);
    const planar<double> chord = seen.last_chord();
    place_ = seen.last.position + f.factor * chord;
    const double from_points = seen.last.variance * norm(planar<double>{1.0 + f.factor.x, f.factor.y}) + seen.before.variance * norm(f.factor);
    const double stretch2 = norm(chord) / norm(seen.first_chord());
    const double of_second = seen.joined ? square(1.0 + std::sqrt(stretch2)) : stretch2;
    const double angle = seen.first.variance * stretch2 + seen.second.variance * of_second + (seen.joined ? 0.0 : seen.before.variance) + seen.last.variance +
                         seen.kinks * square(next.step1());
    const double from_angle = norm(f.derivative) / square(seen.lever()) * angle;
    const double from_kink = seen.last_kink * square(next.step2());
    along_ = from_points + from_angle + 2.0 * std::sqrt(from_points * from_angle) + from_kink;
    across_ = from_points + from_kink;
    const planar<double> moves = f.derivative * chord;
    const double length = std::sqrt(norm(moves));
    direction_ = length > 0.0 ? (1.0 / length) * moves : planar<double>{1.0, 0.0};
  }

  [[nodiscard]] const planar<double>& place() const { return place_; }   ///< tracker frame, mm
  [[nodiscard]] double along() const { return along_; }                  ///< variance along `direction()`, mm^2; not finite where there is no first chord
  [[nodiscard]] double across() const { return across_; }                ///< and across it
  [[nodiscard]] const planar<double>& direction() const { return direction_; }

  /// Squared distance of a point in units of its variance; two degrees of freedom.
  [[nodiscard]] double distance2(const arc_point& point) const {
    const planar<double> off = conjugate(direction_) * (point.position - place_);
    return square(off.x) / (along_ + point.variance) + square(off.y) / (across_ + point.variance);
  }
  /// Half the sides of the box that holds all points of this variance within a squared distance of one.
  [[nodiscard]] planar<double> reach(double variance) const {
    const double a = along_ + variance, b = across_ + variance, x2 = square(direction_.x), y2 = square(direction_.y);
    return {std::sqrt(a * x2 + b * y2), std::sqrt(a * y2 + b * x2)};
  }

 private:
  planar<double> place_, direction_;
  double along_, across_;
};

}  // namespace scifi
