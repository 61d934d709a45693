// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <vector>

#include <scifi/geometry/fibre.hpp>
#include <scifi/geometry/surface.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/particle_to_hit/fibre_crossing.hpp>

namespace scifi {

/// A plane of a tracker as a simulated particle meets it: where it is, what it is made of, and its channels.
struct fibre_layer {
  surface at;
  plane of;
};

/// The layers of a tracker in order of growing z.
[[nodiscard]] inline std::vector<fibre_layer> fibre_layers(const tracker& t) {
  std::vector<fibre_layer> out;
  for (const surface& s : surfaces_along(t, +1))
    for (const station& of : t.stations)
      if (of.id == s.station) out.push_back({s, of.planes[static_cast<std::size_t>(s.plane)]});
  return out;
}

/// Number of the fibre whose core holds the point (alpha, z - z_measured = height), plane frame, mm; -1 outside all cores.
[[nodiscard]] inline int core_at(const plane& p, const fibre_doublet& doublet, double alpha, double height) {
  const double radius2 = 0.25 * doublet.core_diameter * doublet.core_diameter;
  const double number = (fibre_alpha(p, doublet, 0) - alpha) * doublet.fibres_per_channel / p.channel_width;
  for (const int row : {0, 1}) {
    const double rise = height - row_height(doublet, row);
    if (rise * rise >= radius2) continue;
    const double nearest = row + 2.0 * std::round(0.5 * (number - row));
    if (!(nearest >= 0.0 && nearest < p.channels * doublet.fibres_per_channel)) continue;
    const int fibre = static_cast<int>(nearest);
    const double aside = alpha - fibre_alpha(p, doublet, fibre);
    if (aside * aside + rise * rise < radius2) return fibre;
  }
  return -1;
}

}  // namespace scifi
