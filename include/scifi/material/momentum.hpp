// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <limits>

#include <scifi/core/scalar.hpp>

namespace scifi {

/// Momentum after a change of energy, MeV/c, and its derivatives in the momentum before and in the energy lost, each with the other fixed.
template <scalar Scalar>
struct momentum_change {
  Scalar p_new;
  Scalar d_new_d_p;
  Scalar d_new_d_loss;
  Scalar per_new;  ///< 1 / p_new
};

/// `momentum_after_loss` below where E (MeV) and 1/E are known already.
template <scalar Scalar>
[[nodiscard, gnu::always_inline]] inline momentum_change<Scalar> momentum_after_loss(const Scalar& p, double mass, const Scalar& energy, const Scalar& per_energy, const Scalar& energy_lost) {
  using std::sqrt;
  const Scalar p2 = p * p;
  const auto moving = energy_lost * (energy + Scalar(mass)) < p2;  // less than the kinetic energy p^2 / (E + m)
  const Scalar p2_new = p2 - energy_lost * (energy * Scalar(2.0) - energy_lost);
  const Scalar safe = select(moving, p2_new, p2);
  const Scalar root = sqrt(safe);
  const Scalar per_root = Scalar(1.0) / root;
  const Scalar d_new_d_loss = (energy_lost - energy) * per_root;
  const Scalar stopped(std::numeric_limits<double>::quiet_NaN());
  return {select(moving, root, stopped), select(moving, Scalar(-d_new_d_loss * p * per_energy), stopped), select(moving, d_new_d_loss, stopped),
          select(moving, per_root, stopped)};
}

/// p' = sqrt(p^2 - loss (2 E - loss)), E^2 = p^2 + mass^2; p > 0 in MeV/c, mass and energy_lost in MeV.
/// A negative `energy_lost` is a gain: a particle followed against its flight.
/// Fails with NaN in all when nothing of the kinetic energy is left: the particle has stopped.
template <scalar Scalar>
[[nodiscard]] momentum_change<Scalar> momentum_after_loss(const Scalar& p, double mass, const Scalar& energy_lost) {
  using std::sqrt;
  const Scalar energy = sqrt(p * p + Scalar(mass * mass));
  return momentum_after_loss(p, mass, energy, Scalar(Scalar(1.0) / energy), energy_lost);
}

}  // namespace scifi
