// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/units.hpp>
#include <scifi/geometry/fibre.hpp>

namespace scifi {

/// How the flight of a particle through a tracker ended.
enum class flight_end {
  crossed,      ///< it passed every plane
  left,         ///< it went further from the axis than the radius of the tracker, or was nowhere: NaN or infinity at the start
  stopped,      ///< nothing of its kinetic energy was left
  turned_back,  ///< it no longer flew along the direction in which it started
  decayed,      ///< in flight
};

/// What a transport is told besides the tracker.
struct transport_settings {
  double field = 0.0;       ///< Bz in the tracker frame, (MeV/c)/(e mm): B in tesla times units::tesla; for electrons also where another propagator flies the rest
  double radius = 160.0;    ///< particles further from the axis are dropped, mm
  fibre_doublet doublet{};  ///< the sensitive layer of every plane
  double follow_electrons_from = 45.0 * units::keV;  ///< knocked-on electrons are followed from here on: their range in plastic is 0.03 mm
  double most_turns = 20.0;  ///< an electron that would circle more often on its way through a gap is dropped
  bool decays = true;       ///< of muons and charged pions, in flight and, when positive, at rest
};

}  // namespace scifi
