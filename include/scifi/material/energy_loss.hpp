// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/core/constants.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/core/units.hpp>
#include <scifi/material/bethe.hpp>
#include <scifi/material/density_effect.hpp>
#include <scifi/material/kinematics.hpp>
#include <scifi/material/landau.hpp>
#include <scifi/material/particle.hpp>
#include <scifi/material/slab.hpp>

namespace scifi {

/// Energy lost in a slab, MeV, never negative; a particle followed against its flight gains it.
/// Derivatives in the momentum (MeV per MeV/c) and in path_over_thickness (MeV).
template <scalar Scalar>
struct energy_loss {
  Scalar value;
  Scalar d_value_d_p;
  Scalar d_value_d_path_factor;
};

/// No energy loss, said in so many words.
struct no_energy_loss {
  template <scalar Scalar>
  [[nodiscard]] energy_loss<Scalar> loss(const Scalar&, const particle&, const slab&, const Scalar&) const {
    return {Scalar(0.0), Scalar(0.0), Scalar(0.0)};
  }
};

/// Mean loss (Bethe): right for the average energy of many particles, above the typical loss in thin layers.
/// First order in the thickness: `p` is the momentum in the slab; split a slab in which the loss changes much.
struct mean_energy_loss {
  /// p in MeV/c; path_over_thickness = 1/cos(angle to z) >= 1.
  template <scalar Scalar>
  [[nodiscard]] energy_loss<Scalar> loss(const Scalar& p, const particle& hypothesis, const slab& s, const Scalar& path_over_thickness) const {
    const energy_loss_rate<Scalar> rate = mean_energy_loss_rate(p, hypothesis, s.medium);
    const Scalar path = path_over_thickness * Scalar(s.thickness);
    const Scalar value = rate.value * path;
    const Scalar d_value_d_p = rate.d_value_d_p * path;
    const Scalar d_value_d_path_factor = rate.value * Scalar(s.thickness);
    return {value, d_value_d_p, d_value_d_path_factor};
  }
  template <scalar Scalar>
  [[nodiscard]] energy_loss<Scalar> loss(const crossing_particle<Scalar>& crossing, const particle& hypothesis, const slab& s) const {
    return loss(crossing.p, hypothesis, s, crossing.path_over_thickness);
  }
};

namespace detail {

/// Mode plus `offset` xi of the loss in `layers` equal layers, the share of one slab, between zero and the slab's mean loss.
///
/// Both are xi times a bracket that begins with ln(2 m_e beta^2 gamma^2 / I) - delta: Landau's goes on with ln(xi_total / I) + 0.200 - beta^2 (PDG 2024 eq. 34.12),
/// twice Bethe's with ln(T_max / I) - 2 beta^2 (eq. 34.5).
template <scalar Scalar>
[[nodiscard]] energy_loss<Scalar> landau_loss(const crossing_particle<Scalar>& c, const particle& hypothesis, const slab& s, double layers, double offset) {
  using std::log;
  const ionisation_kinematics<Scalar>& k = c.kinematics;
  const Scalar zero(0.0);
  if (!(s.thickness > 0.0)) return {zero, zero, zero};
  const material& medium = s.medium;
  const double excitation = medium.mean_excitation_energy;
  const double charge = hypothesis.charge;
  const double xi_per_mm = 0.5 * constants::bethe_k * charge * charge * medium.z_over_a * medium.density / units::cm;  // times beta^2
  if (!(xi_per_mm > 0.0)) return {zero, zero, zero};
  const Scalar u = k.beta_gamma;
  const Scalar gamma2 = k.gamma * k.gamma;
  const density_effect_correction<Scalar> delta = density_effect(u, c.log_beta_gamma, medium.density_effect);

  const Scalar xi_normal = Scalar(xi_per_mm * s.thickness) / k.beta_squared;
  const Scalar xi = xi_normal * c.path_over_thickness;
  const Scalar common = Scalar(2.0) * c.log_beta_gamma - delta.value - k.beta_squared;
  const Scalar d_log_xi = Scalar(-2.0) / (u * gamma2);
  const Scalar d_beta_squared = -u * u * d_log_xi / gamma2;
  const Scalar d_common = Scalar(2.0) / u - delta.d_value_d_beta_gamma - d_beta_squared;

  // The constants under the logarithms are gathered, one each.
  const double twice_mass = 2.0 * constants::electron_mass / (excitation * excitation);
  const Scalar mode = common + c.log_path - c.log_beta_squared +
                      Scalar(log(twice_mass * xi_per_mm * layer_thickness(s) * layers) + landau::most_probable_offset + offset);
  const Scalar mean = common + c.log_largest_transfer + Scalar(log(twice_mass)) - k.beta_squared;
  const auto thick = mean < mode;
  const Scalar bracket = select(thick, mean, mode);
  const Scalar d_bracket = d_common + select(thick, Scalar(k.d_log_largest_transfer - d_beta_squared), d_log_xi);
  const Scalar by_path = select(thick, Scalar(0.0), Scalar(1.0));

  const auto thin = bracket < zero;
  const Scalar per_mass = Scalar(1.0 / hypothesis.mass);
  return {select(thin, zero, Scalar(xi * bracket)), select(thin, zero, Scalar(xi * (d_log_xi * bracket + d_bracket) * per_mass)),
          select(thin, zero, Scalar(xi_normal * (bracket + by_path)))};
}

}  // namespace detail

/// Most probable loss (Landau-Vavilov, PDG 2024 eq. 34.12), shared over a layer's slices in proportion to their thickness.
///
/// The mode of a sum is not the sum of the modes: a particle that crosses n equal layers most probably loses n times the per-layer value
/// with ln(n xi / I). Set `traversed_layers` = n when the total over a track matters; 1 is the most probable loss of each layer alone.
/// Where Landau's formula would pass the mean (kappa above about 0.3, where it does not hold) the mean is returned, the limit of
/// Vavilov's distribution; where it would turn negative (xi below 1e-5 I), zero.
struct most_probable_energy_loss {
  double traversed_layers = 1.0;

  template <scalar Scalar>
  [[nodiscard]] energy_loss<Scalar> loss(const Scalar& p, const particle& hypothesis, const slab& s, const Scalar& path_over_thickness) const {
    return loss(crossing_particle_of(p, hypothesis, path_over_thickness), hypothesis, s);
  }
  template <scalar Scalar>
  [[nodiscard]] energy_loss<Scalar> loss(const crossing_particle<Scalar>& crossing, const particle& hypothesis, const slab& s) const {
    return detail::landau_loss(crossing, hypothesis, s, traversed_layers, 0.0);
  }
};

/// Median loss: most probable loss plus 1.5786 xi of `traversed_layers` equal layers, shared over them; half of all particles lose more.
/// Bounded by the mean like the most probable loss, which happens from kappa about 0.06 on.
struct median_energy_loss {
  double traversed_layers = 1.0;

  template <scalar Scalar>
  [[nodiscard]] energy_loss<Scalar> loss(const Scalar& p, const particle& hypothesis, const slab& s, const Scalar& path_over_thickness) const {
    return loss(crossing_particle_of(p, hypothesis, path_over_thickness), hypothesis, s);
  }
  template <scalar Scalar>
  [[nodiscard]] energy_loss<Scalar> loss(const crossing_particle<Scalar>& crossing, const particle& hypothesis, const slab& s) const {
    return detail::landau_loss(crossing, hypothesis, s, traversed_layers, landau::median_above_mode);
  }
};

}  // namespace scifi
