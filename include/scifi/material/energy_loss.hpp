// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/scalar.hpp>
#include <scifi/material/bethe.hpp>
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
};

namespace detail {

/// Mode plus `offset` xi of the loss in `layers` equal layers, the share of one slab, between zero and the slab's mean loss.
template <scalar Scalar>
[[nodiscard]] energy_loss<Scalar> landau_loss(const Scalar& p, const particle& hypothesis, const slab& s, const Scalar& path_factor, double layers,
                                              double offset) {
  const ionisation_kinematics<Scalar> k = ionisation_kinematics_of(p, hypothesis);
  const Scalar xi_normal = landau_xi(k, hypothesis, s.medium, Scalar(s.thickness));
  const Scalar xi = xi_normal * path_factor;
  const Scalar xi_total = landau_xi(k, hypothesis, s.medium, Scalar(path_factor * Scalar(layer_thickness(s) * layers)));
  const landau_bracket<Scalar> mode = most_probable_loss_over_xi(k, s.medium, xi_total);
  const Scalar bracket = mode.value + Scalar(offset);
  const Scalar d_log_xi = Scalar(-2.0) / (k.beta_gamma * k.gamma * k.gamma);

  const Scalar value = xi * bracket;
  const Scalar d_value_d_p = xi * (d_log_xi * bracket + mode.d_value_d_beta_gamma) * Scalar(1.0 / hypothesis.mass);
  const Scalar d_value_d_path_factor = xi_normal * (bracket + Scalar(1.0));

  const energy_loss<Scalar> mean = mean_energy_loss{}.loss(p, hypothesis, s, path_factor);
  const auto thick = mean.value < value;
  const auto thin = value < Scalar(0.0);
  const Scalar zero(0.0);
  return {select(thin, zero, select(thick, mean.value, value)), select(thin, zero, select(thick, mean.d_value_d_p, d_value_d_p)),
          select(thin, zero, select(thick, mean.d_value_d_path_factor, d_value_d_path_factor))};
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
    return detail::landau_loss(p, hypothesis, s, path_over_thickness, traversed_layers, 0.0);
  }
};

/// Median loss: most probable loss plus 1.5786 xi of `traversed_layers` equal layers, shared over them; half of all particles lose more.
/// Bounded by the mean like the most probable loss, which happens from kappa about 0.06 on.
struct median_energy_loss {
  double traversed_layers = 1.0;

  template <scalar Scalar>
  [[nodiscard]] energy_loss<Scalar> loss(const Scalar& p, const particle& hypothesis, const slab& s, const Scalar& path_over_thickness) const {
    return detail::landau_loss(p, hypothesis, s, path_over_thickness, traversed_layers, landau::median_above_mode);
  }
};

}  // namespace scifi
