// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/linalg.hpp>
#include <scifi/kalman/concepts.hpp>

namespace scifi {

/// A flight between two surfaces of constant z that also says where it is: the step of propagators in a field that changes along z.
struct stretch {
  double z = 0.0;   ///< where it starts, mm
  double dz = 0.0;  ///< signed distance, mm
};

/// Flies the length of a leg or prepared leg, material left out, with a propagator that takes a `stretch` or, where the place does not matter, a distance.
template <class Flight, class Scalar, class Leg>
[[nodiscard]] kalman::propagated<Scalar, 5> flown(const Flight& flight, const vector<Scalar, 5>& start, const Leg& step) {
  if constexpr (kalman::general_propagator<Flight, Scalar, 5, stretch>) return kalman::propagate(flight, start, stretch{step.z, step.dz});
  else return kalman::propagate(flight, start, step.dz);
}

}  // namespace scifi
