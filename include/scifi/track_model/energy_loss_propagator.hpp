// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/core/linalg.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/kalman/concepts.hpp>
#include <scifi/material/concepts.hpp>
#include <scifi/material/momentum.hpp>
#include <scifi/material/particle.hpp>
#include <scifi/track_model/leg.hpp>
#include <scifi/track_model/slope_state.hpp>

namespace scifi {

/// A propagator of slope_state that flies with another one and loses energy in the material of the leg.
///
/// The direction of flight stays, q/pz scales with p/p'. Energy is lost on a step along `travel` and gained on a step against it. The thin
/// material at the start acts before the flight, the gap and the thin material at the end after it. Jacobian complete, slopes included
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
    const double sign = step.direction == travel ? 1.0 : -1.0;
    const changed<Scalar> before = cross(start, sign, step.start);
    vector<Scalar, 5> departing = start;
    departing[s::q_over_pz] = before.q_over_pz;
    kalman::propagated<Scalar, 5> end = flight.propagate(departing, step.dz);

    // The column of q/pz reaches the slopes at the start through the energy lost there.
    const vector<Scalar, 5> column = end.jacobian.col(s::q_over_pz);
    end.jacobian.col(s::tx) += column * before.d_tx;
    end.jacobian.col(s::ty) += column * before.d_ty;
    end.jacobian.col(s::q_over_pz) = column * before.d_q_over_pz;

    const changed<Scalar> after = cross(end.state, sign, step.gap, step.finish);
    const matrix<Scalar, 1, 5> row = after.d_q_over_pz * end.jacobian.row(s::q_over_pz) + after.d_tx * end.jacobian.row(s::tx) + after.d_ty * end.jacobian.row(s::ty);
    end.jacobian.row(s::q_over_pz) = row;
    end.state[s::q_over_pz] = after.q_over_pz;
    return end;
  }

 private:
  /// q/pz after some material and its derivatives in what it was and in the slopes.
  template <class Scalar>
  struct changed {
    Scalar q_over_pz, d_q_over_pz, d_tx, d_ty;
  };

  template <class Scalar, class... Stacks>
  [[nodiscard]] changed<Scalar> cross(const vector<Scalar, 5>& at, double sign, const Stacks&... stacks) const {
    using s = slope_state;
    using std::sqrt;
    const Scalar k = at[s::q_over_pz];
    if ((stacks.empty() && ...)) return {k, Scalar(1.0), Scalar(0.0), Scalar(0.0)};
    const Scalar tx = at[s::tx];
    const Scalar ty = at[s::ty];
    const Scalar path = sqrt(Scalar(1.0) + tx * tx + ty * ty);
    const Scalar p = path / magnitude(k);
    Scalar lost(0.0);
    Scalar d_lost_d_p(0.0);
    Scalar d_lost_d_path(0.0);
    const auto add = [&](const auto& stack) {
      for (const slab& slice : stack) {
        const energy_loss<Scalar> one = loss.loss(p, hypothesis, slice, path);
        lost += one.value;
        d_lost_d_p += one.d_value_d_p;
        d_lost_d_path += one.d_value_d_path_factor;
      }
    };
    (add(stacks), ...);
    const Scalar signed_loss = Scalar(sign) * lost;
    const momentum_change<Scalar> m = momentum_after_loss(p, hypothesis.mass, signed_loss);
    const Scalar d_new_d_p = m.d_new_d_p + m.d_new_d_loss * Scalar(sign) * d_lost_d_p;  // at fixed path
    const Scalar d_new_d_path = m.d_new_d_loss * Scalar(sign) * d_lost_d_path;          // at fixed p
    const Scalar k_new = k * p / m.p_new;
    const Scalar d_k = k_new / m.p_new * (p / k) * d_new_d_p;
    const Scalar d_path = k_new / path - k_new / m.p_new * (d_new_d_p * p / path + d_new_d_path);
    return {k_new, d_k, Scalar(d_path * tx / path), Scalar(d_path * ty / path)};
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
