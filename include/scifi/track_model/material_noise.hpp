// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/core/linalg.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/kalman/concepts.hpp>
#include <scifi/kalman/symmetric.hpp>
#include <scifi/material/concepts.hpp>
#include <scifi/material/in_slabs.hpp>
#include <scifi/material/particle.hpp>
#include <scifi/track_model/leg.hpp>
#include <scifi/track_model/line_state.hpp>
#include <scifi/track_model/slope_state.hpp>

namespace scifi {

/// Covariance of the slopes (tx, ty) from scattering by a projected angle of the given variance (rad^2), at constant momentum:
/// variance (1 + tx^2 + ty^2) [[1 + tx^2, tx ty], [tx ty, 1 + ty^2]] (Wolin and Ho, NIM A 329 (1993) 493, eqs. 11-13).
template <class Scalar>
[[nodiscard]] matrix<Scalar, 2, 2> slope_covariance(const Scalar& tx, const Scalar& ty, const Scalar& variance) {
  const Scalar scale = variance * (Scalar(1.0) + tx * tx + ty * ty);
  matrix<Scalar, 2, 2> c;
  c(0, 0) = scale * (Scalar(1.0) + tx * tx);
  c(1, 1) = scale * (Scalar(1.0) + ty * ty);
  c(0, 1) = c(1, 0) = scale * tx * ty;
  return c;
}

/// Process noise of slope_state: multiple scattering and energy straggling in the material of a leg.
///
/// Thin material acts on the slopes where it stands; that at the start reaches the end through the Jacobian of the flight (lever arm and turning
/// in the field). The gap is a thick scatterer: per projection theta^2 [[dz^2/3, dz/2], [dz/2, 1]] (PDG 2024, eqs. 34.20-34.22), taken
/// straight, so split a leg in which a dense gap and a turning angle of order one come together. Scattering keeps p, hence moves q/pz with the slopes:
/// cov(q/pz, tx) = (q/pz) tx (1 + tx^2 + ty^2) theta^2. Straggling: (d(q/pz)/dE)^2 var(E).
template <class Scattering, class Straggling>
struct material_noise {
  using state_space = slope_state;
  Scattering scattering;
  Straggling straggling;
  particle hypothesis;

  /// 5 x 5 covariance at the end of the leg; `moved` is what the propagator made of `start`. Widths are taken at the momentum at the start.
  template <class Scalar, class Leg, class Moved>
  [[nodiscard]] matrix<Scalar, 5, 5> covariance(const vector<Scalar, 5>& start, const Leg& step, const Moved& moved) const {
    matrix<Scalar, 5, 5> q;
    covariance_into(q, start, step, moved);
    return q;
  }

  /// The same, written where it is to stay.
  template <class Scalar, class Leg, class Moved>
  [[gnu::always_inline]] void covariance_into(matrix<Scalar, 5, 5>& q, const vector<Scalar, 5>& start, const Leg& step, const Moved& moved) const {
    using s = slope_state;
    if (step.start.empty() && step.gap.empty() && step.finish.empty()) {
      q.setZero();
      return;
    }
    const crossing_particle<Scalar>& crossing = [&]() -> decltype(auto) {
      if constexpr (requires { moved.crossing; }) {
        return (moved.crossing);
      } else {
        crossing_particle<Scalar> own;
        set_crossing_of_slopes(own, start[s::tx], start[s::ty], magnitude(start[s::q_over_pz]), hypothesis);
        return own;
      }
    }();

    set_end(q, step, moved.state, crossing);
    if (!step.start.empty()) carry_start(q, start, moved.jacobian, crossing, widths_of(crossing, step.start));
  }

 private:
  /// What gap and finish give.
  template <class Scalar, class Leg>
  [[gnu::always_inline]] void set_end(matrix<Scalar, 5, 5>& q, const Leg& step, const vector<Scalar, 5>& at, const crossing_particle<Scalar>& crossing) const {
    using s = slope_state;
    const auto set = [&q](int i, int j, const Scalar& value) __attribute__((always_inline)) {
      q(i, j) = value;
      q(j, i) = value;
    };
    const kick<Scalar> c = kick_at(at);
    widths<Scalar> all{Scalar(0.0), Scalar(0.0)};
    if (!step.finish.empty()) all = widths_of(crossing, step.finish);
    if (!step.gap.empty()) {
      const widths<Scalar> gap = widths_of(crossing, step.gap);
      all.angle += gap.angle;
      all.energy += gap.energy;
      const Scalar mixed = gap.angle * Scalar(0.5 * step.dz);
      const Scalar positions = gap.angle * Scalar(step.dz * step.dz / 3.0);
      set(s::x, s::x, positions * c.tx_tx);
      set(s::x, s::y, positions * c.tx_ty);
      set(s::y, s::y, positions * c.ty_ty);
      set(s::x, s::tx, mixed * c.tx_tx);
      set(s::x, s::ty, mixed * c.tx_ty);
      set(s::tx, s::y, mixed * c.tx_ty);
      set(s::y, s::ty, mixed * c.ty_ty);
      set(s::x, s::q_over_pz, mixed * c.tx_k);
      set(s::y, s::q_over_pz, mixed * c.ty_k);
    } else {
      for (int j = 0; j < s::dimension; ++j)
        for (int i = 0; i < s::dimension; ++i)
          if (i == s::x || i == s::y || j == s::x || j == s::y) q(i, j) = Scalar(0.0);
    }
    set(s::tx, s::tx, all.angle * c.tx_tx);
    set(s::tx, s::ty, all.angle * c.tx_ty);
    set(s::ty, s::ty, all.angle * c.ty_ty);
    set(s::tx, s::q_over_pz, all.angle * c.tx_k);
    set(s::ty, s::q_over_pz, all.angle * c.ty_k);
    set(s::q_over_pz, s::q_over_pz, all.angle * c.k_k + lost(at, crossing, all.energy));
  }

  /// Variances of the projected angle (rad^2) and of the energy (MeV^2).
  template <class Scalar>
  struct widths {
    Scalar angle, energy;
  };
  template <class Scalar, class Stack>
  [[nodiscard, gnu::always_inline]] widths<Scalar> widths_of(const crossing_particle<Scalar>& crossing, const Stack& stack) const {
    if constexpr (requires { stack.angle_variance(crossing); }) return {stack.angle_variance(crossing), stack.energy_variance(crossing)};
    else return {variance_in_slabs(scattering, crossing, hypothesis, stack), variance_in_slabs(straggling, crossing, hypothesis, stack)};
  }

  /// Covariance of (tx, ty, q/pz), upper triangle, from a projected angle of unit variance at one place.
  template <class Scalar>
  struct kick {
    Scalar tx_tx, tx_ty, ty_ty, tx_k, ty_k, k_k;
  };
  template <class Scalar>
  [[nodiscard, gnu::always_inline]] static kick<Scalar> kick_at(const vector<Scalar, 5>& at) {
    using s = slope_state;
    const Scalar tx = at[s::tx];
    const Scalar ty = at[s::ty];
    const Scalar k = at[s::q_over_pz];
    const matrix<Scalar, 2, 2> c = slope_covariance(tx, ty, Scalar(1.0));
    const Scalar t2 = tx * tx + ty * ty;
    const Scalar along = (Scalar(1.0) + t2) * k;
    return {c(0, 0), c(0, 1), c(1, 1), Scalar(along * tx), Scalar(along * ty), Scalar(t2 * k * k)};
  }

  /// Variance of q/pz from that of the energy: d(q/pz)/dE = -(q/pz)/p dp/dE, dp/dE = E/p = 1/beta.
  template <class Scalar>
  [[nodiscard, gnu::always_inline]] static Scalar lost(const vector<Scalar, 5>& at, const crossing_particle<Scalar>& crossing, const Scalar& energy) {
    const Scalar k = at[slope_state::q_over_pz];
    return energy * k * k * crossing.per_p_beta_squared;
  }

  /// Adds F C F' for the kick C at the start, which has only the rows and columns tx, ty, q/pz.
  template <class Scalar>
  [[gnu::always_inline]] static void carry_start(matrix<Scalar, 5, 5>& q, const vector<Scalar, 5>& start, const matrix<Scalar, 5, 5>& jacobian, const crossing_particle<Scalar>& crossing, const widths<Scalar>& w) {
    using s = slope_state;
    const kick<Scalar> c = kick_at(start);
    matrix<Scalar, 3, 3> at_start;
    at_start << w.angle * c.tx_tx, w.angle * c.tx_ty, w.angle * c.tx_k,  //
        w.angle * c.tx_ty, w.angle * c.ty_ty, w.angle * c.ty_k,         //
        w.angle * c.tx_k, w.angle * c.ty_k, w.angle * c.k_k + lost(start, crossing, w.energy);
    matrix<Scalar, 5, 3> f;
    f.col(0) = jacobian.col(s::tx);
    f.col(1) = jacobian.col(s::ty);
    f.col(2) = jacobian.col(s::q_over_pz);
    kalman::detail::set_similarity<Scalar, 5, 3>(q, f, at_start, q);
  }
};

template <class Scattering, class Straggling>
material_noise(Scattering, Straggling, particle) -> material_noise<Scattering, Straggling>;

/// Process noise of line_state: multiple scattering at a momentum that is given, not fitted.
template <class Scattering>
struct line_material_noise {
  using state_space = line_state;
  Scattering scattering;
  particle hypothesis;
  double momentum;  ///< MeV/c

  /// 4 x 4 covariance at the end of the leg.
  template <class Scalar>
  [[nodiscard]] matrix<Scalar, 4, 4> covariance(const vector<Scalar, 4>& start, const leg& step) const {
    using s = line_state;
    using std::sqrt;
    const Scalar tx = start[s::tx];
    const Scalar ty = start[s::ty];
    const Scalar path = sqrt(Scalar(1.0) + tx * tx + ty * ty);
    const auto variance = [&](const auto& stack) {
      Scalar sum(0.0);
      for (const slab& slice : stack) sum += scattering.variance(Scalar(momentum), hypothesis, slice, path);
      return sum;
    };
    const Scalar before = variance(step.start);
    const Scalar during = variance(step.gap);
    const Scalar after = variance(step.finish);
    const Scalar dz = Scalar(step.dz);
    // Per unit of slope covariance: position-position, position-slope, slope-slope.
    const Scalar slope_slope = before + during + after;
    const Scalar position_slope = dz * (before + Scalar(0.5) * during);
    const Scalar position_position = dz * dz * (before + Scalar(1.0 / 3.0) * during);
    const matrix<Scalar, 2, 2> c = slope_covariance(tx, ty, Scalar(1.0));
    matrix<Scalar, 4, 4> q;
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        const int xi = i == 0 ? s::x : s::y;
        const int xj = j == 0 ? s::x : s::y;
        const int ti = i == 0 ? s::tx : s::ty;
        const int tj = j == 0 ? s::tx : s::ty;
        q(xi, xj) = position_position * c(i, j);
        q(xi, tj) = q(tj, xi) = position_slope * c(i, j);
        q(ti, tj) = slope_slope * c(i, j);
      }
    }
    return q;
  }
};

template <class Scattering>
line_material_noise(Scattering, particle, double) -> line_material_noise<Scattering>;

}  // namespace scifi
