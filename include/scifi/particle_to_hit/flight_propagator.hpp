// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <concepts>

#include <scifi/core/constants.hpp>
#include <scifi/kalman/concepts.hpp>
#include <scifi/particle_to_hit/helix_step.hpp>
#include <scifi/particle_to_hit/moving_particle.hpp>
#include <scifi/track_model/slope_state.hpp>
#include <scifi/track_model/stretch.hpp>

namespace scifi {

/// p.propagate(moving, dz) gives the particle after dz (mm, either sign) in z, through vacuum and field; NaN where it cannot get there.
/// Law: |p| stays; a step and its reverse cancel; the path may be cut into steps anywhere; time runs with the sign of dz/pz.
/// Optional p.largest_radius(moving, dz): largest distance from the z axis on that way, mm. Without it the middle and the end of a step are looked at.
template <class P>
concept flight_propagator = requires(const P& p, const moving_particle& moving, double dz) {
  { p.propagate(moving, dz) } -> std::same_as<moving_particle>;
};

/// The exact helix of a uniform field along z; the straight line where it is zero.
struct helix_flight {
  double field = 0.0;  ///< Bz in the tracker frame, (MeV/c)/(e mm)

  [[nodiscard]] moving_particle propagate(moving_particle moving, double dz) const {
    helix_step(moving, dz, field);
    return moving;
  }
  [[nodiscard]] double largest_radius(const moving_particle& moving, double dz) const { return scifi::largest_radius(moving, dz, field); }
};

/// Flight by a propagator of the fit: one of slope_state whose step is a `stretch` or a length dz (mm), so that simulation and fit share a field.
/// The momentum keeps its magnitude; the path, for the time, is dz times the mean of p/|pz| at both ends, exact where the field is along z.
template <class Propagator>
struct slope_flight {
  Propagator propagator;

  [[nodiscard]] moving_particle propagate(const moving_particle& moving, double dz) const {
    using s = slope_state;
    const vector<double, 3>& p = moving.momentum;
    vector<double, 5> start;
    start[s::x] = moving.position.x();
    start[s::y] = moving.position.y();
    start[s::tx] = p.x() / p.z();
    start[s::ty] = p.y() / p.z();
    start[s::q_over_pz] = moving.hypothesis.charge / p.z();
    const vector<double, 5> end = moved(start, moving.position.z(), dz);

    const double magnitude = p.norm();
    const double per_dz_start = magnitude / p.z();  // path over dz, with the sign of pz
    const double per_dz_end = std::copysign(std::sqrt(1.0 + end[s::tx] * end[s::tx] + end[s::ty] * end[s::ty]), p.z());
    moving_particle out = moving;
    out.position = {end[s::x], end[s::y], moving.position.z() + dz};
    out.momentum = (magnitude / per_dz_end) * vector<double, 3>(end[s::tx], end[s::ty], 1.0);
    out.t += 0.5 * (per_dz_start + per_dz_end) * dz * moving.energy() / (magnitude * constants::speed_of_light);
    return out;
  }

 private:
  [[nodiscard]] vector<double, 5> moved(const vector<double, 5>& start, double z, double dz) const {
    if constexpr (kalman::general_propagator<Propagator, double, 5, stretch>) return propagator.propagate(start, stretch{z, dz}).state;
    else return propagator.propagate(start, dz).state;
  }
};

template <class Propagator>
slope_flight(Propagator) -> slope_flight<Propagator>;

/// True where a particle that goes from `moving` to `end` over dz is at most `radius` (mm) from the z axis all the way; NaN is not.
template <flight_propagator Propagator>
[[nodiscard]] bool stays_within(double radius, const Propagator& propagator, const moving_particle& moving, const moving_particle& end, double dz) {
  const auto inside = [radius](const moving_particle& m) { return std::hypot(m.position.x(), m.position.y()) <= radius; };
  if (!inside(end)) return false;
  if constexpr (requires { propagator.largest_radius(moving, dz); }) return propagator.largest_radius(moving, dz) <= radius;
  else return inside(moving) && inside(propagator.propagate(moving, 0.5 * dz));
}

}  // namespace scifi
