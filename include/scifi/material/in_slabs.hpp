// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/scalar.hpp>
#include <scifi/material/energy_loss.hpp>
#include <scifi/material/kinematics.hpp>
#include <scifi/material/particle.hpp>
#include <scifi/material/slab.hpp>

/// What a policy says of several stacks of slabs at one momentum. A policy that also takes a `crossing_particle` is given it, so that
/// velocities and logarithms are worked out once for all slabs; any other is asked slab by slab. A `prepared_stack` answers for itself.
namespace scifi {

/// sum += more, with the derivatives.
template <scalar Scalar>
[[gnu::always_inline]] inline void add_loss(energy_loss<Scalar>& sum, const energy_loss<Scalar>& more) {
  sum.value += more.value;
  sum.d_value_d_p += more.d_value_d_p;
  sum.d_value_d_path_factor += more.d_value_d_path_factor;
}

/// Energy lost in all slabs of all stacks, MeV, with its derivatives.
template <class Policy, scalar Scalar, class... Stacks>
[[nodiscard, gnu::always_inline]] inline energy_loss<Scalar> loss_in_slabs(const Policy& policy, const crossing_particle<Scalar>& crossing, const particle& hypothesis, const Stacks&... stacks) {
  energy_loss<Scalar> sum{Scalar(0.0), Scalar(0.0), Scalar(0.0)};
  const auto add = [&](const slab& s) {
    const energy_loss<Scalar> one = [&] {
      if constexpr (requires { policy.loss(crossing, hypothesis, s); }) return policy.loss(crossing, hypothesis, s);
      else return policy.loss(crossing.p, hypothesis, s, crossing.path_over_thickness);
    }();
    add_loss(sum, one);
  };
  const auto add_stack = [&](const auto& stack) __attribute__((always_inline)) {
    if constexpr (requires { stack.loss(crossing); }) {
      if (stack.empty()) return;
      const energy_loss<Scalar> all = stack.loss(crossing);
      add_loss(sum, all);
    } else {
      for (const slab& s : stack) add(s);
    }
  };
  (add_stack(stacks), ...);
  return sum;
}

/// Sum of the variances over the slabs of a stack: of the projected angle (rad^2) or of the energy (MeV^2), as the policy gives it.
template <class Policy, scalar Scalar, class Stack>
[[nodiscard]] Scalar variance_in_slabs(const Policy& policy, const crossing_particle<Scalar>& crossing, const particle& hypothesis, const Stack& stack) {
  Scalar sum(0.0);
  for (const slab& s : stack) {
    if constexpr (requires { policy.variance(crossing, hypothesis, s); }) sum += policy.variance(crossing, hypothesis, s);
    else sum += policy.variance(crossing.p, hypothesis, s, crossing.path_over_thickness);
  }
  return sum;
}

}  // namespace scifi
