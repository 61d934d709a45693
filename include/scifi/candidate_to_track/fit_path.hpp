// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <scifi/geometry/surface.hpp>
#include <scifi/track_model/leg.hpp>

namespace scifi {

/// The way of a fit through a tracker: the measuring surfaces against z, last station first, and behind them the reference surface of the tracker.
///
/// Leg k leads to surface k; leg 0 has no length. The last leg leads to the reference surface (z = 0 of the tracker frame, station 1), where nothing is
/// measured. Between the surfaces of two stations stand thin material, the gas and thin material; between those of one station only thin material, at the end.
struct fit_path {
  std::vector<surface> surfaces;
  std::vector<leg> legs;  ///< one more than surfaces
  double z_reference = 0.0;
};

/// Adds a slab to a stack, to the slab of the same medium and layer if there is one: the order within thin material does not act.
inline void add_to(slab_stack<4>& stack, const slab& more) {
  slab_stack<4> out;
  bool merged = false;
  for (slab s : stack) {
    if (!merged && s.medium == more.medium && s.layer_radiation_lengths == more.layer_radiation_lengths) {
      s.thickness += more.thickness;
      merged = true;
    }
    out.add(s);
  }
  if (!merged) out.add(more);
  stack = out;
}

/// Builds the way for a tracker.
[[nodiscard]] inline fit_path fit_path_of(const tracker& t) {
  constexpr double touching = 1e-6;  // mm: surfaces this close have no gas between them
  fit_path path;
  path.surfaces = surfaces_along(t, -1);
  const auto between = [&t](double from, double to, const slab_stack<4>& leaving, const slab_stack<4>& entering) {
    leg l;
    l.z = from;
    l.dz = to - from;
    l.direction = -1;
    const double free = from - to - thickness(leaving) - thickness(entering);
    if (free > touching) {
      l.start = leaving;
      l.gap.add(whole(t.gas, free));
      l.finish = entering;
    } else {
      l.finish = leaving;
      for (const slab& s : entering) add_to(l.finish, s);
    }
    return l;
  };
  for (std::size_t i = 0; i < path.surfaces.size(); ++i) {
    if (i == 0)
      path.legs.push_back(leg{0.0, -1, {}, {}, {}, path.surfaces[0].z});
    else
      path.legs.push_back(between(path.surfaces[i - 1].z, path.surfaces[i].z, path.surfaces[i - 1].below, path.surfaces[i].above));
  }
  if (!path.surfaces.empty()) {
    const surface& first = path.surfaces.back();
    path.z_reference = first.z_reference;
    path.legs.push_back(between(first.z, first.z_reference, first.below, {}));
  }
  return path;
}

}  // namespace scifi
