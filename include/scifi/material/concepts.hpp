// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <concepts>

#include <scifi/core/scalar.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/particle.hpp>
#include <scifi/material/scattering.hpp>
#include <scifi/material/slab.hpp>
#include <scifi/material/straggling.hpp>

namespace scifi {

namespace detail {

template <class Policy, class Scalar>
concept gives_variance = requires(const Policy policy, const Scalar p, const particle hypothesis, const slab s, const Scalar path_over_thickness) {
  { policy.variance(p, hypothesis, s, path_over_thickness) } -> std::same_as<Scalar>;
};

template <class Policy, class Quantity>
concept declares_variance_of = requires {
  requires std::same_as<typename Policy::variance_of, Quantity>;
};

}  // namespace detail

/// How much energy a particle loses in a slab: loss(p, particle, slab, path_over_thickness) -> energy_loss<Scalar>.
/// Laws: value >= 0; exactly zero for zero thickness; the losses of N slices of a slab at one momentum add up to the slab's;
/// the derivatives are those of the value. Models: mean_energy_loss, most_probable_energy_loss, median_energy_loss, no_energy_loss.
template <class Policy, class Scalar = double>
concept energy_loss_policy = requires(const Policy policy, const Scalar p, const particle hypothesis, const slab s, const Scalar path_over_thickness) {
  { policy.loss(p, hypothesis, s, path_over_thickness) } -> std::same_as<energy_loss<Scalar>>;
};

/// How much a slab scatters: variance(p, particle, slab, path_over_thickness) -> variance of the projected angle, rad^2.
/// Laws: >= 0; exactly zero for zero thickness; the variances of N slices of a slab at one momentum add up to the slab's.
/// A policy may say `using variance_of = scattering_angle;` and is then refused as straggling. Models: highland_scattering, no_scattering.
template <class Policy, class Scalar = double>
concept scattering_policy = detail::gives_variance<Policy, Scalar> && !detail::declares_variance_of<Policy, lost_energy>;

/// How much the energy loss fluctuates: variance(p, particle, slab, path_over_thickness) -> MeV^2.
/// Laws as for scattering_policy. A policy may say `using variance_of = lost_energy;` and is then refused as scattering.
/// Models: bohr_straggling, landau_straggling, no_straggling.
template <class Policy, class Scalar = double>
concept straggling_policy = detail::gives_variance<Policy, Scalar> && !detail::declares_variance_of<Policy, scattering_angle>;

/// Fails to compile, in one sentence, unless `Policy` is an energy-loss policy.
template <class Policy, class Scalar = double>
constexpr void require_energy_loss_policy() {
  static_assert(energy_loss_policy<Policy, Scalar>,
                "scifi: the energy-loss policy needs a const member loss(p, particle, slab, path_over_thickness) that returns "
                "scifi::energy_loss; write no_energy_loss for none.");
}

/// Fails to compile, in one sentence, unless `Policy` is a scattering policy.
template <class Policy, class Scalar = double>
constexpr void require_scattering_policy() {
  static_assert(scattering_policy<Policy, Scalar>,
                "scifi: the scattering policy needs a const member variance(p, particle, slab, path_over_thickness) that returns "
                "the variance of the projected angle in rad^2, not of the energy; write no_scattering for none.");
}

/// Fails to compile, in one sentence, unless `Policy` is a straggling policy.
template <class Policy, class Scalar = double>
constexpr void require_straggling_policy() {
  static_assert(straggling_policy<Policy, Scalar>,
                "scifi: the straggling policy needs a const member variance(p, particle, slab, path_over_thickness) that returns "
                "the variance of the energy loss in MeV^2, not of an angle; write no_straggling for none.");
}

}  // namespace scifi
