// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/chain/reconstruction.hpp>
#include <scifi/field/field_map.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/track_model/nystrom_propagator.hpp>

#include "field/chosen_field.hpp"

/// Calls use(flight_in), where flight_in(tracker) is the tracker_flight of the field chosen: Runge-Kutta-Nystrom through a map, else the helix.
template <class Use>
void with_flight(const chosen_field& field, const Use& use) {
  if (field.mapped())
    use([&field](const scifi::tracker& t) {
      // A thousandth of the resolution of a plane is lost at most.
      constexpr scifi::nystrom_options steps{1e-2};
      const tracker_field& f = field.in(t);
      return scifi::tracker_flight<scifi::nystrom_propagator<scifi::field_map>>{{*f.map, steps}, f.mean};
    });
  else
    use([&field](const scifi::tracker& t) {
      const double mean = field.in(t).mean;
      return scifi::tracker_flight<scifi::helix_propagator>{{mean}, mean};
    });
}
