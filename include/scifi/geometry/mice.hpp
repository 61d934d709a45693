// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <vector>

#include <scifi/core/units.hpp>
#include <scifi/geometry/fibre.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/material/materials.hpp>

/// The two scintillating-fibre trackers of MICE, as surveyed.
namespace scifi::mice {

inline constexpr int upstream = 0;    ///< TKU: the beam meets station 5 first and travels towards -z
inline constexpr int downstream = 1;  ///< TKD: the beam meets station 1 first and travels towards +z

/// One plane: mylar sheet, then the fibre doublet, whose middle is where alpha is measured. Rotation as given, z of the outer mylar surface.
[[nodiscard]] inline plane fibre_plane(const char* view, double angle, int channels, double central_channel, double z, const fibre_doublet& fibre = {}) {
  const material polystyrene = materials::polystyrene;
  const material mylar = materials::mylar;
  const double half = 0.5 * fibre.thickness();
  plane p;
  p.view = view;
  p.angle = angle;
  p.channels = channels;
  p.central_channel = central_channel;
  p.channel_width = fibre.channel_width();
  p.z_reference = z;
  p.z_measured = z + fibre.mylar_thickness + half;
  p.below.add(whole(mylar, fibre.mylar_thickness));
  p.below.add(whole(polystyrene, half));
  p.above.add(whole(polystyrene, half));
  return p;
}

/// A station: V, W, U with 214, 214 and 212 channels, alpha at 120, -120 and 0 degrees; origin (mm, tracker frame) on the outer surface of V.
[[nodiscard]] inline station fibre_station(int id, const vector<double, 3>& origin, const fibre_doublet& fibre = {}) {
  const double step = fibre.mylar_thickness + fibre.thickness();
  station s;
  s.id = id;
  s.in_tracker.origin = origin;
  s.planes = {fibre_plane("V", 120.0 * units::degree, 214, 106.5, 0.0, fibre), fibre_plane("W", -120.0 * units::degree, 214, 106.5, step, fibre),
              fibre_plane("U", 0.0, 212, 105.5, 2.0 * step, fibre)};
  as_one_layer(s);
  return s;
}

/// A tracker from the origins of its stations (mm, tracker frame).
[[nodiscard]] inline tracker fibre_tracker(int id, const char* name, int beam_direction, const std::vector<vector<double, 3>>& origins,
                                           const fibre_doublet& fibre = {}) {
  tracker t;
  t.id = id;
  t.name = name;
  t.beam_direction = beam_direction;
  t.fiducial_radius = 150.0;
  t.active_radius = 160.0;
  t.gas = materials::helium;
  for (const auto& origin : origins) t.stations.push_back(fibre_station(static_cast<int>(t.stations.size()) + 1, origin, fibre));
  return t;
}

/// Both trackers with the surveyed offsets of their stations (survey of the 2015-2017 data taking; station 1 is the origin).
[[nodiscard]] inline detector trackers() {
  detector d;
  d.trackers = {fibre_tracker(upstream, "TKU", -1,
                              {{0.0, 0.0, 0.0}, {-0.5709, -0.7375, 199.9646}, {-1.2021, -0.1657, 449.8276}, {-0.5694, -0.6040, 749.8280}, {0.0, 0.0, 1099.7578}}),
                fibre_tracker(downstream, "TKD", 1,
                              {{0.0, 0.0, 0.0}, {-0.4698, 0.0052, 200.8936}, {-0.6717, -0.1759, 449.8990}, {0.1722, -0.2912, 749.8284}, {0.0, 0.0, 1099.9026}})};
  return d;
}

}  // namespace scifi::mice
