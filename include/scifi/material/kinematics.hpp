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
};

/// Kinematics at momentum p > 0 (MeV/c).
template <scalar Scalar>
[[nodiscard]] ionisation_kinematics<Scalar> ionisation_kinematics_of(const Scalar& p, const particle& hypothesis) {
  using std::sqrt;
  const Scalar beta_gamma = p / Scalar(hypothesis.mass);
  const Scalar u2 = beta_gamma * beta_gamma;
  const Scalar gamma2 = u2 + Scalar(1.0);
  const Scalar gamma = sqrt(gamma2);
  const Scalar beta_squared = u2 / gamma2;
  const double ratio = constants::electron_mass / hypothesis.mass;
  const Scalar denominator = gamma * Scalar(2.0 * ratio) + Scalar(1.0 + ratio * ratio);
  const Scalar largest_transfer = u2 * Scalar(2.0 * constants::electron_mass) / denominator;
  const Scalar d_log = Scalar(2.0) / beta_gamma - beta_gamma * Scalar(2.0 * ratio) / (gamma * denominator);
  return {beta_gamma, gamma, beta_squared, largest_transfer, d_log};
}

/// A particle on its way through matter at an angle: what the formulae of all slabs share, so that it is worked out once.
template <scalar Scalar>
struct crossing_particle {
  ionisation_kinematics<Scalar> kinematics;
  Scalar p;                     ///< MeV/c
  Scalar path_over_thickness;   ///< 1/cos(angle to z) >= 1
  Scalar log_beta_gamma;
  Scalar log_beta_squared;
  Scalar log_largest_transfer;  ///< of T_max in MeV
  Scalar log_path;              ///< of path_over_thickness
};

/// p > 0 in MeV/c, path_over_thickness >= 1.
template <scalar Scalar>
[[nodiscard]] crossing_particle<Scalar> crossing_particle_of(const Scalar& p, const particle& hypothesis, const Scalar& path_over_thickness) {
  using std::log;
  const ionisation_kinematics<Scalar> k = ionisation_kinematics_of(p, hypothesis);
  const Scalar log_beta_gamma = log(k.beta_gamma);
  const Scalar log_beta_squared = Scalar(2.0) * (log_beta_gamma - log(k.gamma));
  return {k, p, path_over_thickness, log_beta_gamma, log_beta_squared, log(k.largest_transfer), log(path_over_thickness)};
}

}  // namespace scifi
