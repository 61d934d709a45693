// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include <scifi/core/refuse.hpp>
#include <scifi/geometry/channel_id.hpp>
#include <scifi/geometry/station.hpp>
#include <scifi/material/material.hpp>

namespace scifi {

/// A telescope of stations along z. Tracker frame: z grows from station 1 to the last, z = 0 is the reference surface of station 1.
struct tracker {
  int id = 0;                    ///< 0 TKU, 1 TKD
  std::string name;              ///< for messages and tables
  int beam_direction = 1;        ///< +1 when the beam travels towards +z of the tracker frame, -1 towards -z
  double fiducial_radius = 0.0;  ///< mm, about the axis: where efficiency is quoted
  double active_radius = 0.0;    ///< mm, about the axis of a station: nothing beyond it can be real; has to be given
  material gas;                  ///< what fills the space between the stations
  std::vector<station> stations;
};

/// Throws std::invalid_argument, naming the culprit, where nothing could be reconstructed: no active radius, a plane without channels, planes that are not
/// listed in order of growing z (those of one station may share theirs).
inline void check(const tracker& t) {
  const auto refuse = [&t](const std::string& why) { detail::refuse<std::invalid_argument>("tracker " + (t.name.empty() ? std::to_string(t.id) : t.name) + ": " + why); };
  if (!(t.active_radius > 0.0)) refuse("active_radius must be above zero: nothing beyond it is taken for real");
  std::string last;
  double last_z = 0.0;
  for (const station& s : t.stations) {
    for (std::size_t i = 0; i < s.planes.size(); ++i) {
      const plane& p = s.planes[i];
      const double z = s.in_tracker.origin.z() + p.z_measured;
      const std::string here = "plane " + std::to_string(i) + " of station " + std::to_string(s.id);
      if (p.channels <= 0 || !(p.channel_width > 0.0)) refuse(here + " has no channels, or none of a width above zero");
      if (!last.empty() && !(i > 0 ? z >= last_z : z > last_z))
        refuse(here + ", at z = " + std::to_string(z) + " mm, must lie behind " + last + ", at z = " + std::to_string(last_z) + " mm, which is listed before it");
      last = here;
      last_z = z;
    }
  }
}

/// All trackers of an experiment.
struct detector {
  std::vector<tracker> trackers;

  /// The tracker with this id, or nullptr.
  [[nodiscard]] const tracker* find(int id) const {
    for (const tracker& t : trackers)
      if (t.id == id) return &t;
    return nullptr;
  }
  /// The plane that a channel id belongs to, or nullptr when tracker, station or plane do not exist.
  [[nodiscard]] const plane* find_plane(const channel_id& id) const {
    const tracker* t = find(id.tracker);
    if (t == nullptr) return nullptr;
    for (const station& s : t->stations)
      if (s.id == id.station && id.plane >= 0 && static_cast<std::size_t>(id.plane) < s.planes.size())
        return &s.planes[static_cast<std::size_t>(id.plane)];
    return nullptr;
  }
};

}  // namespace scifi
