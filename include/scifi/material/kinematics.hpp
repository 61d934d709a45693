// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/core/constants.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/material/particle.hpp>

namespace scifi {

/// Velocity and largest energy transfer of a particle, with the logarithmic derivatives that the loss formulas share.
template <scalar Scalar>
struct ionisation_kinematics {
  Scalar beta_gamma;
  Scalar gamma;
  Scalar beta_squared;
  /// Largest energy (MeV) given to a free electron in one collision, PDG 2024 eq. 34.4.
  Scalar largest_transfer;
  /// d ln(largest_transfer) / d(beta gamma).
  Scalar d_log_largest_transfer;
  /// Inverses: divisions are dear.
  Scalar per_beta_gamma, per_gamma_squared, per_beta_squared;
};

/// Kinematics at momentum p > 0 (MeV/c).
template <scalar Scalar>
[[nodiscard, gnu::always_inline]] inline ionisation_kinematics<Scalar> ionisation_kinematics_of(const Scalar& p, const particle& hypothesis) {
  using std::sqrt;
  const double ratio = constants::electron_mass / hypothesis.mass;
  const Scalar beta_gamma = p * Scalar(1.0 / hypothesis.mass);
  const Scalar u2 = beta_gamma * beta_gamma;
  const Scalar gamma2 = u2 + Scalar(1.0);
  const Scalar gamma = sqrt(gamma2);
  const Scalar per_beta_gamma = Scalar(1.0) / beta_gamma;
  const Scalar per_gamma2 = Scalar(1.0) / gamma2;
  const Scalar per_beta_squared = Scalar(1.0) + per_beta_gamma * per_beta_gamma;
  const Scalar denominator = gamma * Scalar(2.0 * ratio) + Scalar(1.0 + ratio * ratio);
  const Scalar per_denominator = Scalar(1.0) / denominator;
  const Scalar largest_transfer = u2 * Scalar(2.0 * constants::electron_mass) * per_denominator;
  const Scalar d_log = Scalar(2.0) * per_beta_gamma - beta_gamma * Scalar(2.0 * ratio) * gamma * per_gamma2 * per_denominator;
  return {beta_gamma, gamma, u2 * per_gamma2, largest_transfer, d_log, per_beta_gamma, per_gamma2, per_beta_squared};
}

/// A particle on its way through matter at an angle: what the formulae of all slabs share, so that it is worked out once.
template <scalar Scalar>
struct crossing_particle {
  ionisation_kinematics<Scalar> kinematics;
  Scalar p;                           ///< MeV/c
  Scalar per_p;                       ///< 1 / p
  Scalar path_over_thickness;         ///< 1/cos(angle to z) >= 1
  Scalar path_over_beta_squared;      ///< path_over_thickness / beta^2
  Scalar per_p_beta_squared;          ///< 1 / (p beta)^2
  Scalar log_beta_gamma;
  Scalar log_path_over_beta_squared;
};

/// p > 0 in MeV/c, path_over_thickness >= 1.
template <scalar Scalar>
[[nodiscard, gnu::always_inline]] inline crossing_particle<Scalar> crossing_particle_of(const Scalar& p, const particle& hypothesis, const Scalar& path_over_thickness) {
  using std::log;
  const ionisation_kinematics<Scalar> k = ionisation_kinematics_of(p, hypothesis);
  const Scalar per_p = k.per_beta_gamma * Scalar(1.0 / hypothesis.mass);
  const Scalar path_over_beta_squared = path_over_thickness * k.per_beta_squared;
  const Scalar log_beta_gamma = log(k.beta_gamma);
  const Scalar log_path_over_beta_squared = log(path_over_beta_squared);
  return {k, p, per_p, path_over_thickness, path_over_beta_squared, Scalar(per_p * per_p * k.per_beta_squared), log_beta_gamma, log_path_over_beta_squared};
}

}  // namespace scifi
