// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include <scifi/field/field_map.hpp>
#include <scifi/particle_to_hit/flight_propagator.hpp>
#include <scifi/track_model/nystrom_propagator.hpp>

#include "field/chosen_field.hpp"

namespace scifi::simulate {

/// The flight of a simulated particle in the field that the user chose: one type for both kinds, so that the transport is compiled once.
class chosen_flight {
 public:
  explicit chosen_flight(const tracker_field& field) : way_(helix_flight{field.mean}) {
    if (field.map) way_ = through_map{{*field.map}};
  }

  [[nodiscard]] moving_particle propagate(const moving_particle& moving, double dz) const {
    return std::visit([&](const auto& way) { return way.propagate(moving, dz); }, way_);
  }
  [[nodiscard]] double largest_radius(const moving_particle& moving, double dz) const {
    if (const auto* const helix = std::get_if<helix_flight>(&way_)) return helix->largest_radius(moving, dz);
    const auto radius = [&](double share) {
      const moving_particle there = propagate(moving, share * dz);
      return std::hypot(there.position.x(), there.position.y());
    };
    const double middle = radius(0.5), end = radius(1.0);
    if (std::isnan(middle) || std::isnan(end)) return std::numeric_limits<double>::quiet_NaN();
    return std::max({radius(0.0), middle, end});
  }

 private:
  using through_map = slope_flight<nystrom_propagator<field_map>>;
  std::variant<helix_flight, through_map> way_;
};

}  // namespace scifi::simulate
