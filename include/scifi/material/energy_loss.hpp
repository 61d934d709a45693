// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cstddef>

#include <scifi/core/scalar.hpp>
#include <scifi/material/bethe.hpp>
#include <scifi/material/kinematics.hpp>
#include <scifi/material/landau.hpp>
#include <scifi/material/landau_loss.hpp>
#include <scifi/material/particle.hpp>
#include <scifi/material/slab.hpp>

namespace scifi {

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
    return loss_in_landau_slabs(crossing, hypothesis, std::array{prepared_slab(hypothesis, s)});
  }
  [[nodiscard]] landau_slab prepared_slab(const particle& hypothesis, const slab& s) const { return landau_slab_of(hypothesis, s, traversed_layers, 0.0); }
  template <std::size_t Capacity>
  [[nodiscard]] prepared_landau_loss<Capacity> prepared(const particle& hypothesis, const slab_stack<Capacity>& stack) const {
    inline_vector<landau_slab, Capacity> slabs;
    for (const slab& s : stack) slabs.push_back(prepared_slab(hypothesis, s));
    return {hypothesis, slabs};
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
    return loss_in_landau_slabs(crossing, hypothesis, std::array{prepared_slab(hypothesis, s)});
  }
  [[nodiscard]] landau_slab prepared_slab(const particle& hypothesis, const slab& s) const { return landau_slab_of(hypothesis, s, traversed_layers, landau::median_above_mode); }
  template <std::size_t Capacity>
  [[nodiscard]] prepared_landau_loss<Capacity> prepared(const particle& hypothesis, const slab_stack<Capacity>& stack) const {
    inline_vector<landau_slab, Capacity> slabs;
    for (const slab& s : stack) slabs.push_back(prepared_slab(hypothesis, s));
    return {hypothesis, slabs};
  }
};

}  // namespace scifi
