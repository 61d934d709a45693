// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/core/scalar.hpp>
#include <scifi/material/kinematics.hpp>
#include <scifi/material/particle.hpp>

namespace scifi {

/// Constants of Highland's formula as refitted by Lynch and Dahl, Nucl. Instrum. Methods B 58 (1991) 6; PDG 2024 eq. 34.16.
namespace highland {

inline constexpr double energy = 13.6;  ///< MeV
inline constexpr double log_coefficient = 0.038;

}  // namespace highland

/// Variance theta0^2 (rad^2) of the scattering angle projected on a plane, PDG 2024 eq. 34.16:
/// theta0 = 13.6 MeV/(beta p) z sqrt(x/X0) (1 + 0.038 ln(x z^2 / (X0 beta^2))).
///
/// The logarithm takes the whole layer's x/X0 and the variance the share x/x_layer of the layer's, so the variances of slices add up.
/// Both thicknesses are along the true path (1/cos included). p > 0 in MeV/c. Fits Moliere's core to 11 % for 1e-3 < x/X0 < 100;
/// the factor of the logarithm is held at zero or above, which happens below x z^2/(X0 beta^2) = 4e-12. Zero thickness gives exactly zero.
template <scalar Scalar>
[[nodiscard]] Scalar highland_variance(const Scalar& p, const particle& hypothesis, const Scalar& radiation_lengths_along_path,
                                       const Scalar& layer_radiation_lengths_along_path) {
  using std::log;
  const double charge2 = static_cast<double>(hypothesis.charge) * hypothesis.charge;
  const Scalar p2 = p * p;
  const Scalar inverse_beta2 = Scalar(1.0) + Scalar(hypothesis.mass * hypothesis.mass) / p2;
  const Scalar argument = layer_radiation_lengths_along_path * inverse_beta2 * Scalar(charge2);
  const auto nothing = argument <= Scalar(0.0);
  const Scalar safe_argument = select(nothing, Scalar(1.0), argument);
  const Scalar correction = larger_of(Scalar(Scalar(1.0) + log(safe_argument) * Scalar(highland::log_coefficient)), Scalar(0.0));
  const Scalar unit = inverse_beta2 / p2 * Scalar(highland::energy * highland::energy * charge2);
  return select(nothing, Scalar(0.0), Scalar(unit * radiation_lengths_along_path * correction * correction));
}

/// The same for a particle whose logarithms are known already; thicknesses at normal incidence.
template <scalar Scalar>
[[nodiscard]] Scalar highland_variance(const crossing_particle<Scalar>& crossing, const particle& hypothesis, double radiation_lengths, double layer_radiation_lengths) {
  using std::log;
  const double charge2 = static_cast<double>(hypothesis.charge) * hypothesis.charge;
  if (radiation_lengths <= 0.0 || charge2 == 0.0) return Scalar(0.0);
  const Scalar logarithm = Scalar(log(layer_radiation_lengths * charge2)) + crossing.log_path_over_beta_squared;
  const Scalar correction = larger_of(Scalar(Scalar(1.0) + logarithm * Scalar(highland::log_coefficient)), Scalar(0.0));
  const Scalar unit = Scalar(highland::energy * highland::energy * charge2 * radiation_lengths) * crossing.per_p_beta_squared;
  return unit * crossing.path_over_thickness * correction * correction;
}

/// The variance that a stack of slabs gives, prepared for any momentum: with L = ln(path/beta^2) a polynomial of second degree in L.
///
/// A layer so thin that the factor of Highland's logarithm would be held at zero, x z^2/X0 < 4e-12, counts as nothing.
struct prepared_highland {
  double constant = 0.0, linear = 0.0, quadratic = 0.0;

  /// Adds a slab: thicknesses at normal incidence, of the slab and of its layer.
  void add(const particle& hypothesis, double radiation_lengths, double layer_radiation_lengths) {
    const double charge2 = static_cast<double>(hypothesis.charge) * hypothesis.charge;
    if (radiation_lengths <= 0.0 || charge2 == 0.0) return;
    const double correction = 1.0 + std::log(layer_radiation_lengths * charge2) * highland::log_coefficient;
    if (correction <= 0.0) return;
    const double scale = highland::energy * highland::energy * charge2 * radiation_lengths;
    constant += scale * correction * correction;
    linear += scale * 2.0 * correction * highland::log_coefficient;
    quadratic += scale * highland::log_coefficient * highland::log_coefficient;
  }

  /// Of the projected angle, rad^2.
  template <scalar Scalar>
  [[nodiscard, gnu::always_inline]] Scalar variance(const crossing_particle<Scalar>& c) const {
    const Scalar l = c.log_path_over_beta_squared;
    return (Scalar(constant) + l * (Scalar(linear) + l * Scalar(quadratic))) * c.path_over_thickness * c.per_p_beta_squared;
  }
};

}  // namespace scifi
