// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>

#include <scifi/material/in_slabs.hpp>

namespace scifi {

namespace detail {

/// Stands in for what a policy without `prepared` would give: it is asked slab by slab each time.
template <class Policy, std::size_t Capacity>
struct asked_each_time {
  Policy policy;
  particle hypothesis;
  slab_stack<Capacity> stack;

  template <scalar Scalar>
  [[nodiscard]] energy_loss<Scalar> loss(const crossing_particle<Scalar>& crossing) const {
    return loss_in_slabs(policy, crossing, hypothesis, stack);
  }
  template <scalar Scalar>
  [[nodiscard]] Scalar variance(const crossing_particle<Scalar>& crossing) const {
    return variance_in_slabs(policy, crossing, hypothesis, stack);
  }
};

/// policy.prepared(hypothesis, stack), where the policy has it: all that does not depend on the momentum, worked out once.
template <class Policy, std::size_t Capacity>
[[nodiscard]] auto prepared(const Policy& policy, const particle& hypothesis, const slab_stack<Capacity>& stack) {
  if constexpr (requires { policy.prepared(hypothesis, stack); }) return policy.prepared(hypothesis, stack);
  else return asked_each_time<Policy, Capacity>{policy, hypothesis, stack};
}

template <class Policy, std::size_t Capacity>
using prepared_type = decltype(prepared(std::declval<const Policy&>(), std::declval<const particle&>(), std::declval<const slab_stack<Capacity>&>()));

}  // namespace detail

/// A stack of slabs with what three policies say of it for one kind of particle, prepared for any momentum.
template <class EnergyLoss, class Scattering, class Straggling, std::size_t Capacity>
class prepared_stack {
 public:
  prepared_stack(const EnergyLoss& loss, const Scattering& scattering, const Straggling& straggling, const particle& hypothesis, const slab_stack<Capacity>& stack)
      : empty_(stack.empty()),
        loss_(detail::prepared(loss, hypothesis, stack)),
        scattering_(detail::prepared(scattering, hypothesis, stack)),
        straggling_(detail::prepared(straggling, hypothesis, stack)) {}

  [[nodiscard]] bool empty() const { return empty_; }

  /// Energy lost, MeV, with its derivatives.
  template <scalar Scalar>
  [[nodiscard, gnu::always_inline]] energy_loss<Scalar> loss(const crossing_particle<Scalar>& crossing) const {
    return loss_.loss(crossing);
  }
  /// Of the projected angle, rad^2.
  template <scalar Scalar>
  [[nodiscard, gnu::always_inline]] Scalar angle_variance(const crossing_particle<Scalar>& crossing) const {
    return scattering_.variance(crossing);
  }
  /// Of the energy, MeV^2.
  template <scalar Scalar>
  [[nodiscard, gnu::always_inline]] Scalar energy_variance(const crossing_particle<Scalar>& crossing) const {
    return straggling_.variance(crossing);
  }

 private:
  bool empty_;
  detail::prepared_type<EnergyLoss, Capacity> loss_;
  detail::prepared_type<Scattering, Capacity> scattering_;
  detail::prepared_type<Straggling, Capacity> straggling_;
};

}  // namespace scifi
