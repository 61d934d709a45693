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
  Scalar per_beta_gamma, per_beta_gamma_squared, per_gamma_squared, per_beta_squared;
};

namespace detail {

/// Kinematics from beta gamma, its inverse and the square of that; written where they are to stay.
template <scalar Scalar>
[[gnu::always_inline]] inline void set_kinematics(ionisation_kinematics<Scalar>& out, const Scalar& beta_gamma, const Scalar& per_beta_gamma, const Scalar& per_beta_gamma_squared,
                                                  const particle& hypothesis) {
  using std::sqrt;
  const double ratio = constants::electron_mass / hypothesis.mass;
  const Scalar u2 = beta_gamma * beta_gamma;
  const Scalar gamma = sqrt(Scalar(u2 + Scalar(1.0)));
  const Scalar per_beta_squared = Scalar(1.0) + per_beta_gamma_squared;
  const Scalar beta_squared = Scalar(1.0) / per_beta_squared;
  const Scalar per_gamma2 = per_beta_gamma_squared * beta_squared;
  const Scalar per_denominator = Scalar(1.0) / (gamma * Scalar(2.0 * ratio) + Scalar(1.0 + ratio * ratio));
  out.beta_gamma = beta_gamma;
  out.gamma = gamma;
  out.beta_squared = beta_squared;
  out.largest_transfer = u2 * Scalar(2.0 * constants::electron_mass) * per_denominator;
  out.d_log_largest_transfer = Scalar(2.0) * per_beta_gamma - beta_gamma * Scalar(2.0 * ratio) * gamma * per_gamma2 * per_denominator;
  out.per_beta_gamma = per_beta_gamma;
  out.per_beta_gamma_squared = per_beta_gamma_squared;
  out.per_gamma_squared = per_gamma2;
  out.per_beta_squared = per_beta_squared;
}

}  // namespace detail

/// Kinematics at momentum p > 0 (MeV/c).
template <scalar Scalar>
[[nodiscard, gnu::always_inline]] inline ionisation_kinematics<Scalar> ionisation_kinematics_of(const Scalar& p, const particle& hypothesis) {
  const Scalar per_beta_gamma = Scalar(hypothesis.mass) / p;
  ionisation_kinematics<Scalar> out;
  detail::set_kinematics(out, Scalar(p * Scalar(1.0 / hypothesis.mass)), per_beta_gamma, Scalar(per_beta_gamma * per_beta_gamma), hypothesis);
  return out;
}

/// A particle on its way through matter at an angle: what the formulae of all slabs share, so that it is worked out once.
template <scalar Scalar>
struct crossing_particle {
  ionisation_kinematics<Scalar> kinematics;
  Scalar p;                           ///< MeV/c
  Scalar per_p;                       ///< 1 / p
  Scalar path_over_thickness;         ///< 1/cos(angle to z) >= 1
  Scalar per_path_squared;            ///< cos(angle to z)^2
  Scalar path_over_beta_squared;      ///< path_over_thickness / beta^2
  Scalar per_p_beta_squared;          ///< 1 / (p beta)^2
  Scalar log_path_over_beta_squared;
};

namespace detail {

/// With the path (1/cos) and the inverse of its square, p and 1/p, and (mass/p)^2, on which alone the logarithm waits.
template <scalar Scalar>
[[gnu::always_inline]] inline void set_crossing(crossing_particle<Scalar>& out, const Scalar& path, const Scalar& per_path_squared, const Scalar& p, const Scalar& per_p,
                                                const Scalar& per_beta_gamma_squared, const particle& hypothesis) {
  using std::log;
  const Scalar per_beta_squared = Scalar(1.0) + per_beta_gamma_squared;
  const Scalar path_over_beta_squared = path * per_beta_squared;
  out.log_path_over_beta_squared = log(path_over_beta_squared);
  set_kinematics(out.kinematics, Scalar(p * Scalar(1.0 / hypothesis.mass)), Scalar(per_p * Scalar(hypothesis.mass)), per_beta_gamma_squared, hypothesis);
  out.p = p;
  out.per_p = per_p;
  out.path_over_thickness = path;
  out.per_path_squared = per_path_squared;
  out.path_over_beta_squared = path_over_beta_squared;
  out.per_p_beta_squared = per_p * per_p * per_beta_squared;
}

}  // namespace detail

/// p > 0 in MeV/c, path_over_thickness >= 1.
template <scalar Scalar>
[[nodiscard, gnu::always_inline]] inline crossing_particle<Scalar> crossing_particle_of(const Scalar& p, const particle& hypothesis, const Scalar& path_over_thickness) {
  const Scalar per_p = Scalar(1.0) / p;
  const Scalar per_beta_gamma_squared = per_p * per_p * Scalar(hypothesis.mass * hypothesis.mass);
  crossing_particle<Scalar> out;
  detail::set_crossing(out, path_over_thickness, Scalar(Scalar(1.0) / (path_over_thickness * path_over_thickness)), p, per_p, per_beta_gamma_squared, hypothesis);
  return out;
}

/// The same of a particle with slopes tx and ty and |q/pz| (1/(MeV/c)) above zero, written where it is to stay.
template <scalar Scalar>
[[gnu::always_inline]] inline void set_crossing_of_slopes(crossing_particle<Scalar>& out, const Scalar& tx, const Scalar& ty, const Scalar& per_pz, const particle& hypothesis) {
  using std::sqrt;
  const Scalar path_squared = Scalar(1.0) + tx * tx + ty * ty;
  const Scalar per_path_squared = Scalar(1.0) / path_squared;
  const Scalar path = sqrt(path_squared);
  const Scalar per_beta_gamma_squared = per_pz * per_pz * Scalar(hypothesis.mass * hypothesis.mass) * per_path_squared;
  detail::set_crossing(out, path, per_path_squared, Scalar(path / per_pz), Scalar(per_pz * path * per_path_squared), per_beta_gamma_squared, hypothesis);
}

}  // namespace scifi
