// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/core/constants.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/core/units.hpp>
#include <scifi/material/density_effect.hpp>
#include <scifi/material/kinematics.hpp>
#include <scifi/material/material.hpp>
#include <scifi/material/particle.hpp>

namespace scifi {

/// Numbers of the Landau density f(lambda); the energy loss is distributed as xi lambda plus a constant.
namespace landau {

inline constexpr double mode = -0.22278298;
inline constexpr double median = 1.35578042099;
/// Full width at half maximum in lambda, so 4.018 xi in energy (PDG 2024 section 34.2.9).
inline constexpr double full_width = 4.018;
/// (median - mode) in lambda: the median loss lies 1.5786 xi above the most probable one.
inline constexpr double median_above_mode = median - mode;
/// j of PDG 2024 eq. 34.12 (Bichsel, Rev. Mod. Phys. 60 (1988) 663).
inline constexpr double most_probable_offset = 0.200;
/// Full width at half maximum of a Gaussian in standard deviations, 2 sqrt(2 ln 2).
inline constexpr double gaussian_full_width = 2.35482004503094938;
/// Standard deviation in lambda of the Gaussian with the Landau density's width at half maximum.
inline constexpr double core_width = full_width / gaussian_full_width;

}  // namespace landau

/// xi beta^2 per path, K/2 Z/A z^2 rho, MeV/mm.
[[nodiscard]] inline double landau_xi_per_mm(const particle& hypothesis, const material& medium) {
  const double charge = hypothesis.charge;
  return 0.5 * constants::bethe_k * charge * charge * medium.z_over_a * medium.density / units::cm;
}

/// xi = K/2 Z/A z^2 rho x / beta^2 (MeV), PDG 2024 below eq. 34.12, for a path of `path` mm.
template <scalar Scalar>
[[nodiscard]] Scalar landau_xi(const ionisation_kinematics<Scalar>& k, const particle& hypothesis, const material& medium, const Scalar& path) {
  return path * Scalar(landau_xi_per_mm(hypothesis, medium)) / k.beta_squared;
}

/// kappa = xi / T_max: Landau's limit below about 0.01, a Gaussian above about 10.
template <scalar Scalar>
[[nodiscard]] Scalar vavilov_kappa(const Scalar& xi, const ionisation_kinematics<Scalar>& k) {
  return xi / k.largest_transfer;
}

/// Variance (MeV^2) of the whole energy-loss distribution, xi T_max (1 - beta^2/2), the second moment of the Rutherford cross-section
/// with spin 1/2 (Bohr; Rossi, High-Energy Particles (1952) 2.7.7). Rare large transfers make up most of it when kappa is small.
template <scalar Scalar>
[[nodiscard]] Scalar bohr_variance(const Scalar& xi, const ionisation_kinematics<Scalar>& k) {
  return xi * k.largest_transfer * (Scalar(1.0) - k.beta_squared * Scalar(0.5));
}

/// The bracket of the most probable loss, Delta_p / xi, and its derivative in beta gamma.
template <scalar Scalar>
struct landau_bracket {
  Scalar value;
  Scalar d_value_d_beta_gamma;
};

/// Delta_p / xi = ln(2 m_e beta^2 gamma^2 / I) + ln(xi / I) + 0.200 - beta^2 - delta, PDG 2024 eq. 34.12 (Landau-Vavilov-Bichsel),
/// where xi (MeV) is that of the whole thickness the most probable loss is wanted for, taken to vary as 1/beta^2.
/// Valid for xi well above I and kappa below about 0.1. A thickness of zero gives a finite number, to be multiplied by xi = 0.
template <scalar Scalar>
[[nodiscard]] landau_bracket<Scalar> most_probable_loss_over_xi(const ionisation_kinematics<Scalar>& k, const material& medium, const Scalar& xi) {
  using std::log;
  const density_effect_correction<Scalar> delta = density_effect(k.beta_gamma, medium.density_effect);
  const double excitation = medium.mean_excitation_energy;
  const Scalar u = k.beta_gamma;
  const Scalar gamma2 = k.gamma * k.gamma;
  const Scalar safe_xi = select(Scalar(0.0) < xi, xi, Scalar(excitation));
  const Scalar value = log(u * u * Scalar(2.0 * constants::electron_mass / excitation)) + log(safe_xi * Scalar(1.0 / excitation)) +
                       Scalar(landau::most_probable_offset) - k.beta_squared - delta.value;
  const Scalar d_value = Scalar(2.0) / u - Scalar(2.0) / (u * gamma2) - u * Scalar(2.0) / (gamma2 * gamma2) - delta.d_value_d_beta_gamma;
  return {value, d_value};
}

}  // namespace scifi
