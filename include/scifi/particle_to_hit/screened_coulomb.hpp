// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/core/constants.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/material/particle.hpp>

namespace scifi {

/// Single scattering off the atoms of a path: dn = 2 chi_c^2 theta dtheta / (theta^2 + chi_a^2)^2 (Moliere; Bethe, Phys. Rev. 89 (1953) 1256).
struct screened_coulomb {
  double chi_c2;  ///< rad^2: chi_c^2 / theta^2 scatters turn by more than theta, where screening does not matter
  double chi_a2;  ///< rad^2: the screening angle
};

/// How strongly the electrons of an atom hide its nucleus, as a factor on Moliere's chi_a^2.
namespace screening {

/// Moliere's own value.
inline constexpr double moliere = 1.0;
/// The Wentzel model of Geant4 (Ivanchenko et al., J. Phys. Conf. Ser. 219 (2010) 032045, and the toolkit from 9.5 on): 1 + exp(-Z^2/1000), so 1.965 for carbon.
[[nodiscard]] inline double wentzel(double nuclear_charge) { return 1.0 + std::exp(-1.0e-3 * nuclear_charge * nuclear_charge); }

}  // namespace screening

/// chi_a^2 = factor chi_0^2 (1.13 + 3.76 (z Z alpha / beta)^2), chi_0 = alpha m_e Z^(1/3) / (0.885 p), and
/// chi_c^2 = (E_s / 2)^2 z^2 x / (X0 ln(287 / sqrt(Z))) / (p beta)^2, E_s = m_e sqrt(4 pi / alpha), from the definition of X0 (PDG 2024, eq. 34.27).
/// p in MeV/c, `radiation_lengths` = x/X0 along the path, Z the charge of the nuclei that scatter most, 3 < Z < 20.
[[nodiscard]] inline screened_coulomb screened_coulomb_of(double p, const particle& hypothesis, double radiation_lengths, double nuclear_charge, double factor) {
  constexpr double alpha = 1.0 / 137.035999;
  const double z = hypothesis.charge;
  const double beta2 = p * p / (p * p + hypothesis.mass * hypothesis.mass);
  const double quarter_es2 = constants::pi / alpha * constants::electron_mass * constants::electron_mass;
  const double shape = std::log(287.0 / std::sqrt(nuclear_charge));
  const double chi_0 = alpha * constants::electron_mass * std::cbrt(nuclear_charge) / (0.885 * p);
  const double coulomb = z * nuclear_charge * alpha;
  return {quarter_es2 * z * z * radiation_lengths / (shape * p * p * beta2), factor * chi_0 * chi_0 * (1.13 + 3.76 * coulomb * coulomb / beta2)};
}

}  // namespace scifi
