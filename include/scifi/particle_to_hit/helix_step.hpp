// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <scifi/core/constants.hpp>
#include <scifi/core/trigonometry.hpp>
#include <scifi/particle_to_hit/moving_particle.hpp>

namespace scifi {

/// Moves a particle by dz (mm, either sign) in vacuum, exactly, in a uniform field Bz, (MeV/c)/(e mm): the transverse momentum turns by
/// -theta, theta = q Bz dz / pz (Lorentz force dpx/dz = q Bz py/pz, dpy/dz = -q Bz px/pz; Jackson, Classical Electrodynamics, 12.2).
/// Time runs with the sign of dz/pz. pz must not be zero.
inline void helix_step(moving_particle& moving, double dz, double field) {
  const double px = moving.momentum.x();
  const double py = moving.momentum.y();
  const double per_pz = dz / moving.momentum.z();
  const turning<double> t = turning_at(moving.hypothesis.charge * field * per_pz);
  moving.position.x() += per_pz * (t.s1 * px + t.c1 * py);
  moving.position.y() += per_pz * (t.s1 * py - t.c1 * px);
  moving.position.z() += dz;
  moving.momentum.x() = t.cosine * px + t.sine * py;
  moving.momentum.y() = t.cosine * py - t.sine * px;
  moving.t += per_pz * moving.energy() / constants::speed_of_light;
}

/// Largest distance from the z axis (mm) on the way through `helix_step(moving, dz, field)`.
[[nodiscard]] inline double largest_radius(const moving_particle& moving, double dz, double field) {
  moving_particle end = moving;
  helix_step(end, dz, field);
  const double at_ends = std::max(std::hypot(moving.position.x(), moving.position.y()), std::hypot(end.position.x(), end.position.y()));
  const double curvature_momentum = moving.hypothesis.charge * field;
  if (std::abs(curvature_momentum) == 0.0) return at_ends;  // a straight line is furthest out at one of its ends

  // Centre of the circle: from dp/dt = q v x B, (px, py)/(qB) turned by a right angle.
  const double from_centre_x = -moving.momentum.y() / curvature_momentum;
  const double from_centre_y = moving.momentum.x() / curvature_momentum;
  const double centre_x = moving.position.x() - from_centre_x;
  const double centre_y = moving.position.y() - from_centre_y;
  // The outermost point lies beyond the centre; it is passed when the angle up to it is within the turned one. The turn is by -theta.
  const double turned = -curvature_momentum * dz / moving.momentum.z();
  double to_outermost = std::atan2(from_centre_x * centre_y - from_centre_y * centre_x, from_centre_x * centre_x + from_centre_y * centre_y);
  if (turned > 0.0 && to_outermost < 0.0) to_outermost += 2.0 * constants::pi;
  if (turned < 0.0 && to_outermost > 0.0) to_outermost -= 2.0 * constants::pi;
  const bool passed = std::abs(to_outermost) <= std::abs(turned);
  return passed ? std::hypot(centre_x, centre_y) + std::hypot(from_centre_x, from_centre_y) : at_ends;
}

}  // namespace scifi
