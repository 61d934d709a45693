// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/chain/reconstruction.hpp>
#include <scifi/field/field_map.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/nystrom_propagator.hpp>

#include "field/chosen_field.hpp"

/// How tracks fly in a uniform field that was chosen.
struct helix_flight {
  const chosen_field& field;
  [[nodiscard]] scifi::tracker_flight<scifi::helix_propagator> operator()(const scifi::tracker& t) const {
    const double mean = field.in(t).mean;
    return {{mean}, mean};
  }
};

/// How tracks fly through a map that was chosen: Runge-Kutta-Nystrom.
struct map_flight {
  const chosen_field& field;
  [[nodiscard]] scifi::tracker_flight<scifi::nystrom_propagator<scifi::field_map>> operator()(const scifi::tracker& t) const {
    // A thousandth of the resolution of a plane is lost at most.
    constexpr scifi::nystrom_options steps{1e-2};
    const tracker_field& f = field.in(t);
    return {{*f.map, steps}, f.mean};
  }
};

/// Calls use(flight_in), where flight_in(tracker) is the tracker_flight of the field chosen.
template <class Use>
void with_flight(const chosen_field& field, const Use& use) {
  if (field.mapped()) use(map_flight{field});
  else use(helix_flight{field});
}
