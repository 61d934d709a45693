// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <string_view>

namespace scifi {

/// What multiple scattering and ionisation need to know of a homogeneous medium; units as in the tables of the PDG.
/// The name must outlive the material (a literal does).
struct material {
  /// Parameters of the density effect, PDG 2024 eq. 34.7: delta(log10(beta gamma)); `c` is the positive number C-bar of the tables.
  struct sternheimer {
    double a, m, x0, x1, c, delta0;
    friend constexpr bool operator==(const sternheimer&, const sternheimer&) = default;
  };

  std::string_view name;
  double density;                 ///< g/cm3
  double radiation_length;        ///< mm
  double z_over_a;                ///< mol/g
  double mean_excitation_energy;  ///< MeV
  sternheimer density_effect;

  /// By name and every number: media that a file describes may share a name.
  friend constexpr bool operator==(const material&, const material&) = default;
};

}  // namespace scifi
