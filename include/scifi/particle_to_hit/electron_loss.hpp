// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/core/constants.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/core/units.hpp>
#include <scifi/material/density_effect.hpp>
#include <scifi/material/material.hpp>
#include <scifi/material/particle.hpp>
#include <scifi/particle_to_hit/screened_coulomb.hpp>

namespace scifi {

/// Mean energy (MeV/mm) that an electron of kinetic energy T (MeV) loses to the electrons of a medium, PDG 2024 eq. 34.24 (Moller scattering):
/// K/2 Z/A rho / beta^2 [ln(m_e beta^2 gamma^2 m_e (gamma - 1) / (2 I^2)) + 1 - beta^2 - (2 gamma - 1)/gamma^2 ln 2 + ((gamma - 1)/gamma)^2 / 8 - delta].
/// T >= 10 keV; positrons lose 3 % less to 5 % more. Without bremsstrahlung, 0.5 % of the loss in plastic at 1 MeV and half as much again at 50 MeV.
[[nodiscard]] inline double electron_stopping_power(double kinetic_energy, const material& medium) {
  const double tau = kinetic_energy / constants::electron_mass;
  const double gamma = 1.0 + tau;
  const double u2 = tau * (tau + 2.0);
  const double beta2 = u2 / (gamma * gamma);
  const double delta = density_effect(std::sqrt(u2), medium.density_effect).value;
  const double excitation = medium.mean_excitation_energy / constants::electron_mass;
  const double bracket = std::log(0.5 * u2 * tau / (excitation * excitation)) + 1.0 - beta2 - (2.0 * gamma - 1.0) / (gamma * gamma) * std::log(2.0) +
                         0.125 * square(tau / gamma) - delta;
  return 0.5 * constants::bethe_k * medium.z_over_a * medium.density / units::cm / beta2 * bracket;
}

/// 1/lambda_1 (1/mm): the mean of 1 - cos(angle) per path of an electron or positron, from the single scattering of `screened_coulomb_of` carried on
/// to all angles: chi_c^2/2 (ln(1 + 1/A) - 1/(1 + A)), A = chi_a^2/4. p in MeV/c. After a path s the mean of the cosine is exp(-s/lambda_1) (Goudsmit, Saunderson).
[[nodiscard]] inline double electron_transport_rate(double p, const particle& hypothesis, const material& medium, double nuclear_charge = 6.0) {
  const auto [chi_c2, chi_a2] = screened_coulomb_of(p, hypothesis, 1.0 / medium.radiation_length, nuclear_charge, screening::moliere);
  const double a = 0.25 * chi_a2;
  return 0.5 * chi_c2 * (std::log1p(1.0 / a) - 1.0 / (1.0 + a));
}

}  // namespace scifi
