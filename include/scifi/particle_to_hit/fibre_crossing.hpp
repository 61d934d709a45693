// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <scifi/core/inline_vector.hpp>
#include <scifi/geometry/fibre.hpp>
#include <scifi/geometry/plane.hpp>

namespace scifi {

/// A straight piece of track through the core of a fibre.
struct fibre_crossing {
  int fibre = 0;         ///< number in its plane, 0 .. channels * fibres_per_channel - 1
  double entry = 0.0;    ///< path from the given point to the core's surface along the flight, mm; negative before the point
  double chord = 0.0;    ///< path inside the core, mm
};

/// Cores of one row that a track can cross; further ones are left out, which takes slopes above 5.
inline constexpr int max_fibre_crossings = 8;

/// Coordinate of the axis of a fibre, plane frame, mm: the middle fibre of a channel lies at the channel's alpha, and alpha falls as the number grows.
[[nodiscard]] inline double fibre_alpha(const plane& p, const fibre_doublet& doublet, int fibre) {
  const double middle = 0.5 * (doublet.fibres_per_channel - 1);
  return p.alpha((fibre - middle) / doublet.fibres_per_channel);
}

/// Channel that reads a fibre.
[[nodiscard]] constexpr int channel_of_fibre(const fibre_doublet& doublet, int fibre) { return fibre / doublet.fibres_per_channel; }

/// Height of the axes of a row above the middle of the doublet, mm: row 0 (even fibres) at smaller z, row 1 (odd fibres) at larger.
[[nodiscard]] constexpr double row_height(const fibre_doublet& doublet, int row) { return (row == 0 ? -0.5 : 0.5) * doublet.row_separation; }

/// The cores of one row (0 or 1) that a straight track crosses, in the order of its flight.
///
/// The track passes (alpha, z - z_measured = height), plane frame, mm, with the unit direction (d_alpha, d_beta, d_z); d_z must not be zero.
/// A core is a cylinder along beta: at distance b of the track from its axis the chord is 2 sqrt(r^2 - b^2) / sqrt(d_alpha^2 + d_z^2).
[[nodiscard]] inline inline_vector<fibre_crossing, max_fibre_crossings> fibre_crossings(const plane& p, const fibre_doublet& doublet, int row, double alpha,
                                                                                       double height, const vector<double, 3>& direction) {
  const double d_alpha = direction.x();
  const double d_z = direction.z();
  const double across = std::hypot(d_alpha, d_z);
  const double radius = 0.5 * doublet.core_diameter;
  const double rise = row_height(doublet, row) - height;
  const double alpha_at_row = alpha + rise * d_alpha / d_z;
  const double reach = radius * across / std::abs(d_z);  // cores further than this along alpha are missed

  const double step = p.channel_width / doublet.fibres_per_channel;
  const double at_row = (fibre_alpha(p, doublet, 0) - alpha_at_row) / step;  // as a fractional fibre number
  const double lowest = std::max(0.0, std::ceil(at_row - reach / step));
  const double highest = std::min(p.channels * doublet.fibres_per_channel - 1.0, std::floor(at_row + reach / step));

  inline_vector<fibre_crossing, max_fibre_crossings> out;
  if (!(lowest <= highest)) return out;
  const int first = static_cast<int>(lowest);
  const int last = static_cast<int>(highest);
  for (int fibre = first + (first % 2 == row ? 0 : 1); fibre <= last; fibre += 2) {
    const double to_axis = fibre_alpha(p, doublet, fibre) - alpha;
    const double distance = (to_axis * d_z - rise * d_alpha) / across;
    const double half = radius * radius - distance * distance;
    if (!(half > 0.0)) continue;
    const double half_chord = std::sqrt(half) / across;
    const double closest = (to_axis * d_alpha + rise * d_z) / (across * across);
    if (!out.push_back({fibre, closest - half_chord, 2.0 * half_chord})) break;
  }
  // Cores of a row do not overlap, and alpha falls as the fibre number grows: a track towards growing alpha meets them in falling order.
  if (d_alpha > 0.0) std::reverse(out.begin(), out.end());
  return out;
}

}  // namespace scifi
