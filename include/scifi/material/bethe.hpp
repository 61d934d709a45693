// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <limits>

#include <scifi/core/constants.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/core/units.hpp>
#include <scifi/material/density_effect.hpp>
#include <scifi/material/kinematics.hpp>
#include <scifi/material/material.hpp>
#include <scifi/material/particle.hpp>

namespace scifi {

/// Energy lost per path length, MeV/mm, positive, and its derivative in the momentum, (MeV/mm)/(MeV/c).
template <scalar Scalar>
struct energy_loss_rate {
  Scalar value;
  Scalar d_value_d_p;
};

/// Mean energy loss by ionisation, Bethe's formula, PDG 2024 eq. 34.5:
/// -dE/dx = K z^2 Z/A rho / beta^2 (ln(2 m_e beta^2 gamma^2 T_max / I^2)/2 - beta^2 - delta/2).
///
/// p > 0 in MeV/c. Muon tables are met to 0.3 % for 0.4 < beta gamma < 10; at beta gamma = 0.15 (protons of 10 MeV) shell corrections are
/// missing, up to 1.6 %, at 100 the radiation of struck electrons, 1 %. Below beta gamma = sqrt(I / 2 m_e), about 0.01, the
/// bracket turns negative and the value is NaN. Electrons and positrons above 1 MeV: 3 % below the collision loss of Moller and Bhabha scattering (PDG 2024
/// eq. 34.24), and without bremsstrahlung, which exceeds it in plastic above 100 MeV.
template <scalar Scalar>
[[nodiscard]] energy_loss_rate<Scalar> mean_energy_loss_rate(const Scalar& p, const particle& hypothesis, const material& medium) {
  using std::log;
  const ionisation_kinematics<Scalar> k = ionisation_kinematics_of(p, hypothesis);
  const density_effect_correction<Scalar> delta = density_effect(k.beta_gamma, medium.density_effect);
  const double charge = hypothesis.charge;
  const double factor = constants::bethe_k * charge * charge * medium.z_over_a * medium.density / units::cm;
  const double excitation = medium.mean_excitation_energy;

  const Scalar u = k.beta_gamma;
  const Scalar gamma2 = k.gamma * k.gamma;
  const Scalar per_beta_squared = Scalar(factor) / k.beta_squared;
  const Scalar logarithm = log(u * u * Scalar(2.0 * constants::electron_mass / excitation)) + log(k.largest_transfer * Scalar(1.0 / excitation));
  const Scalar bracket = (logarithm - delta.value) * Scalar(0.5) - k.beta_squared;

  const Scalar d_log_factor = Scalar(-2.0) / (u * gamma2);  // d ln(1/beta^2)/d(beta gamma)
  const Scalar d_beta_squared = u * Scalar(2.0) / (gamma2 * gamma2);
  const Scalar d_bracket = (Scalar(2.0) / u + k.d_log_largest_transfer - delta.d_value_d_beta_gamma) * Scalar(0.5) - d_beta_squared;
  const Scalar value = select(bracket > Scalar(0.0), Scalar(per_beta_squared * bracket), Scalar(std::numeric_limits<double>::quiet_NaN()));
  const Scalar d_value_d_p = per_beta_squared * (d_log_factor * bracket + d_bracket) * Scalar(1.0 / hypothesis.mass);
  return {value, d_value_d_p};
}

}  // namespace scifi
