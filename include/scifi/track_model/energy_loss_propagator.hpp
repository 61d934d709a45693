// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <type_traits>

#include <scifi/core/linalg.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/kalman/concepts.hpp>
#include <scifi/material/concepts.hpp>
#include <scifi/material/in_slabs.hpp>
#include <scifi/material/momentum.hpp>
#include <scifi/material/particle.hpp>
#include <scifi/track_model/leg.hpp>
#include <scifi/track_model/slope_state.hpp>
#include <scifi/track_model/stretch.hpp>

namespace scifi {

/// A propagator of slope_state that flies with another one and loses energy in the material of the leg.
///
/// The flight takes a distance (helix_propagator) or a `stretch` (nystrom_propagator).
/// The direction of flight stays, q/pz scales with p/p'. Energy is lost on a step along `travel` and gained on a step against it. The thin
/// material at the start acts before the flight, the gap and the thin material at the end after it; the loss of both is taken at the momentum at the
/// start of the leg, right while a leg takes a small share of the energy (split it otherwise). Jacobian complete, slopes included
/// (path 1/cos = sqrt(1 + tx^2 + ty^2)). A particle that stops ends with NaN in q/pz, which the filter reports as a failed prediction.
template <class Flight, class EnergyLoss>
struct energy_loss_propagator {
  using state_space = slope_state;
  Flight flight;
  EnergyLoss loss;
  particle hypothesis;
  int travel = 1;  ///< direction of the particle in z: +1 or -1

  /// State (5, slope_state) at the end of the leg and its Jacobian d_end_d_start (5 x 5).
  template <class Scalar>
  [[nodiscard]] kalman::propagated<Scalar, 5> propagate(const vector<Scalar, 5>& start, const leg& step) const {
    using s = slope_state;
    using std::sqrt;
    if (std::is_same_v<EnergyLoss, no_energy_loss> || (step.start.empty() && step.gap.empty() && step.finish.empty())) return flown(flight, start, step);

    const Scalar tx = start[s::tx];
    const Scalar ty = start[s::ty];
    const Scalar path = sqrt(Scalar(1.0) + tx * tx + ty * ty);
    const Scalar p = path / magnitude(start[s::q_over_pz]);
    const Scalar sign(step.direction == travel ? 1.0 : -1.0);
    const crossing_particle<Scalar> crossing = crossing_particle_of(p, hypothesis, path);
    const energy_loss<Scalar> before = loss_in_slabs(loss, crossing, hypothesis, step.start);
    energy_loss<Scalar> total = loss_in_slabs(loss, crossing, hypothesis, step.gap, step.finish);
    total.value += before.value;
    total.d_value_d_p += before.d_value_d_p;
    total.d_value_d_path_factor += before.d_value_d_path_factor;

    const changed<Scalar> departing =
        step.start.empty() ? changed<Scalar>{start[s::q_over_pz], Scalar(1.0), Scalar(0.0), Scalar(0.0)} : after_loss(start, p, path, sign, before);
    const changed<Scalar> arriving = after_loss(start, p, path, sign, total);
    vector<Scalar, 5> flying = start;
    flying[s::q_over_pz] = departing.q_over_pz;
    kalman::propagated<Scalar, 5> end = flown(flight, flying, step);

    // The flight starts with the q/pz that the loss left, which the slopes at the start have a hand in.
    auto& j = end.jacobian;
    for (int i = 0; i < s::dimension; ++i) {
      const Scalar by_k = j(i, s::q_over_pz);
      j(i, s::tx) += by_k * departing.d_tx;
      j(i, s::ty) += by_k * departing.d_ty;
      j(i, s::q_over_pz) = by_k * departing.d_q_over_pz;
    }
    // What is lost after the departure scales the q/pz that the flight, which may turn pz, leaves.
    const Scalar scale = arriving.q_over_pz / departing.q_over_pz;
    const Scalar flown_k = end.state[s::q_over_pz] / departing.q_over_pz;
    for (int i = 0; i < s::dimension; ++i) j(s::q_over_pz, i) *= scale;
    j(s::q_over_pz, s::tx) += flown_k * (arriving.d_tx - scale * departing.d_tx);
    j(s::q_over_pz, s::ty) += flown_k * (arriving.d_ty - scale * departing.d_ty);
    j(s::q_over_pz, s::q_over_pz) += flown_k * (arriving.d_q_over_pz - scale * departing.d_q_over_pz);
    end.state[s::q_over_pz] *= scale;
    return end;
  }

 private:
  /// q/pz after some material and its derivatives in q/pz and the slopes before.
  template <class Scalar>
  struct changed {
    Scalar q_over_pz, d_q_over_pz, d_tx, d_ty;
  };

  template <class Scalar>
  [[nodiscard]] changed<Scalar> after_loss(const vector<Scalar, 5>& at, const Scalar& p, const Scalar& path, const Scalar& sign, const energy_loss<Scalar>& lost) const {
    using s = slope_state;
    const Scalar k = at[s::q_over_pz];
    const momentum_change<Scalar> m = momentum_after_loss(p, hypothesis.mass, Scalar(sign * lost.value));
    const Scalar d_new_d_p = m.d_new_d_p + m.d_new_d_loss * sign * lost.d_value_d_p;       // at fixed path
    const Scalar d_new_d_path = m.d_new_d_loss * sign * lost.d_value_d_path_factor;        // at fixed p
    const Scalar per_p = Scalar(1.0) / m.p_new;
    const Scalar k_new = k * p * per_p;
    const Scalar k_per_p = k_new * per_p;
    // p = path / |k|, k' = sign(k) path / p'.
    const Scalar d_path_over_path = (k_new - k_per_p * (d_new_d_p * p + d_new_d_path * path)) / (path * path);
    return {k_new, Scalar(k_per_p * p / k * d_new_d_p), Scalar(d_path_over_path * at[s::tx]), Scalar(d_path_over_path * at[s::ty])};
  }
};

template <class Flight, class EnergyLoss>
energy_loss_propagator(Flight, EnergyLoss, particle, int) -> energy_loss_propagator<Flight, EnergyLoss>;

/// The legs of a straight track: only the distance counts.
template <class Flight>
struct leg_propagator {
  using state_space = typename Flight::state_space;
  Flight flight;
  [[nodiscard]] auto transition(const leg& step) const { return flight.transition(step.dz); }
};

template <class Flight>
leg_propagator(Flight) -> leg_propagator<Flight>;

}  // namespace scifi
