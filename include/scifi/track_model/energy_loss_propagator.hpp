// SPDX-License-Identifier: MPL-2.0
#pragma once

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

/// A propagated slope_state with what the formulae of the material at the start of the leg share, for the noise to use again.
template <class Scalar>
struct propagated_in_matter : kalman::propagated<Scalar, 5> {
  crossing_particle<Scalar> crossing;  ///< set where the leg has material
};

/// The same, written where it is to stay.
template <class Scalar>
struct propagated_view_in_matter : kalman::propagated_view<Scalar, 5> {
  explicit propagated_view_in_matter(const kalman::propagated_view<Scalar, 5>& to) : kalman::propagated_view<Scalar, 5>(to) {}
  crossing_particle<Scalar> crossing;  ///< set where the leg has material
};

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
  static constexpr auto unit_columns = kalman::unit_columns<Flight>;
  Flight flight;
  EnergyLoss loss;
  particle hypothesis;
  int travel = 1;  ///< direction of the particle in z: +1 or -1

  /// State (5, slope_state) at the end of the leg and its Jacobian d_end_d_start (5 x 5). The leg is a `leg` or a `prepared_leg`.
  template <class Scalar, class Leg>
  [[nodiscard]] auto propagate(const vector<Scalar, 5>& start, const Leg& step) const {
    if constexpr (std::is_same_v<EnergyLoss, no_energy_loss>) {
      return flown(flight, start, step);
    } else {
      propagated_in_matter<Scalar> end;
      end.crossing = propagate_into(kalman::propagated_view<Scalar, 5>{end.state, end.jacobian}, start, step).crossing;
      return end;
    }
  }

  /// The same, written where it is to stay, which is not where it starts.
  template <class Scalar, class Leg>
  [[gnu::always_inline]] auto propagate_into(const kalman::propagated_view<Scalar, 5>& to, const vector<Scalar, 5>& start, const Leg& step) const {
    if constexpr (std::is_same_v<EnergyLoss, no_energy_loss>) {
      fly(to, start, step);
      return to;
    } else {
      return through_matter(to, start, step);
    }
  }

 private:
  template <class Scalar, class Leg>
  [[nodiscard, gnu::always_inline]] propagated_view_in_matter<Scalar> through_matter(const kalman::propagated_view<Scalar, 5>& to, const vector<Scalar, 5>& start, const Leg& step) const {
    using s = slope_state;
    propagated_view_in_matter<Scalar> end(to);
    const bool in_matter = !(step.start.empty() && step.gap.empty() && step.finish.empty());
    changed<Scalar> departing{start[s::q_over_pz], Scalar(1.0), Scalar(0.0), Scalar(0.0)};
    changed<Scalar> arriving = departing;
    if (in_matter) {
      const Scalar sign(step.direction == travel ? 1.0 : -1.0);
      set_crossing_of_slopes(end.crossing, start[s::tx], start[s::ty], magnitude(start[s::q_over_pz]), hypothesis);
      const crossing_particle<Scalar>& crossing = end.crossing;
      energy_loss<Scalar> total = loss_in_slabs(loss, crossing, hypothesis, step.gap, step.finish);
      if (!step.start.empty()) {
        const energy_loss<Scalar> before = loss_in_slabs(loss, crossing, hypothesis, step.start);
        add_loss(total, before);
        departing = after_loss(start, crossing, sign, before);
      }
      arriving = after_loss(start, crossing, sign, total);
    }
    vector<Scalar, 5> flying = start;
    flying[s::q_over_pz] = departing.q_over_pz;
    fly(end, flying, step);
    if (!in_matter) return end;

    // The flight starts with the q/pz that the loss left, which the slopes at the start have a hand in.
    auto& j = end.jacobian;
    for (int i = 0; i < s::dimension && !step.start.empty(); ++i) {
      const Scalar by_k = j(i, s::q_over_pz);
      j(i, s::tx) += by_k * departing.d_tx;
      j(i, s::ty) += by_k * departing.d_ty;
      j(i, s::q_over_pz) = by_k * departing.d_q_over_pz;
    }
    if constexpr (requires { requires Flight::keeps_q_over_pz; }) {
      j(s::q_over_pz, s::tx) = arriving.d_tx;
      j(s::q_over_pz, s::ty) = arriving.d_ty;
      j(s::q_over_pz, s::q_over_pz) = arriving.d_q_over_pz;
      end.state[s::q_over_pz] = arriving.q_over_pz;
    } else {
      // What is lost after the departure scales the q/pz that the flight, which may turn pz, leaves.
      const Scalar scale = arriving.q_over_pz / departing.q_over_pz;
      const Scalar flown_k = end.state[s::q_over_pz] / departing.q_over_pz;
      for (int i = 0; i < s::dimension; ++i) j(s::q_over_pz, i) *= scale;
      j(s::q_over_pz, s::tx) += flown_k * (arriving.d_tx - scale * departing.d_tx);
      j(s::q_over_pz, s::ty) += flown_k * (arriving.d_ty - scale * departing.d_ty);
      j(s::q_over_pz, s::q_over_pz) += flown_k * (arriving.d_q_over_pz - scale * departing.d_q_over_pz);
      end.state[s::q_over_pz] *= scale;
    }
    return end;
  }

  template <class Scalar, class Leg>
  [[gnu::always_inline]] void fly(const kalman::propagated_view<Scalar, 5>& end, const vector<Scalar, 5>& start, const Leg& step) const {
    if constexpr (requires { flight.propagate_into(end, start, step.dz); }) {
      flight.propagate_into(end, start, step.dz);
    } else {
      const kalman::propagated<Scalar, 5> moved = flown(flight, start, step);
      end.state = moved.state;
      end.jacobian = moved.jacobian;
    }
  }

  /// q/pz after some material and its derivatives in q/pz and the slopes before.
  template <class Scalar>
  struct changed {
    Scalar q_over_pz, d_q_over_pz, d_tx, d_ty;
  };

  template <class Scalar>
  [[nodiscard, gnu::always_inline]] changed<Scalar> after_loss(const vector<Scalar, 5>& at, const crossing_particle<Scalar>& c, const Scalar& sign, const energy_loss<Scalar>& lost) const {
    using s = slope_state;
    const Scalar k = at[s::q_over_pz];
    const Scalar energy = c.kinematics.gamma * Scalar(hypothesis.mass);
    const Scalar per_energy = c.kinematics.gamma * c.kinematics.per_gamma_squared * Scalar(1.0 / hypothesis.mass);
    const momentum_change<Scalar> m = momentum_after_loss(c.p, hypothesis.mass, energy, per_energy, Scalar(sign * lost.value));
    const Scalar d_new_d_p = m.d_new_d_p + m.d_new_d_loss * sign * lost.d_value_d_p;  // at fixed path
    const Scalar d_new_d_path = m.d_new_d_loss * sign * lost.d_value_d_path_factor;   // at fixed p
    const Scalar p_over_new = c.p * m.per_new;  // NaN for a particle that stopped
    const Scalar k_new = k * p_over_new;
    // p = path / |k|, k' = sign(k) path / p'.
    const Scalar d_path_over_path = (k_new - k_new * m.per_new * (d_new_d_p * c.p + d_new_d_path * c.path_over_thickness)) * c.per_path_squared;
    return {k_new, Scalar(p_over_new * p_over_new * d_new_d_p), Scalar(d_path_over_path * at[s::tx]), Scalar(d_path_over_path * at[s::ty])};
  }
};

template <class Flight, class EnergyLoss>
energy_loss_propagator(Flight, EnergyLoss, particle, int) -> energy_loss_propagator<Flight, EnergyLoss>;

/// The legs of a straight track: only the distance counts.
template <class Flight>
struct leg_propagator {
  using state_space = typename Flight::state_space;
  static constexpr auto unit_columns = kalman::unit_columns<Flight>;
  Flight flight;
  [[nodiscard]] auto transition(const leg& step) const { return flight.transition(step.dz); }
};

template <class Flight>
leg_propagator(Flight) -> leg_propagator<Flight>;

}  // namespace scifi
