// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <utility>

#include <scifi/core/linalg.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/kalman/concepts.hpp>
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
    using s = slope_state;
    using std::sqrt;
    matrix<Scalar, 5, 5> q = matrix<Scalar, 5, 5>::Zero();
    if (step.start.empty() && step.gap.empty() && step.finish.empty()) return q;
    const crossing_particle<Scalar>& crossing = [&]() -> decltype(auto) {
      if constexpr (requires { moved.crossing; }) {
        return (moved.crossing);
      } else {
        const Scalar path = sqrt(Scalar(1.0) + square(Scalar(start[s::tx])) + square(Scalar(start[s::ty])));
        return crossing_particle_of(Scalar(path / magnitude(start[s::q_over_pz])), hypothesis, path);
      }
    }();

    if (!step.finish.empty()) add_kick(q, scatter(moved.state, crossing, step.finish));
    if (!step.gap.empty()) {
      const kick<Scalar> thick = scatter(moved.state, crossing, step.gap);
      add_kick(q, thick);
      const Scalar half = Scalar(0.5 * step.dz);
      const Scalar third = Scalar(step.dz * step.dz / 3.0);
      q(s::x, s::x) += third * thick.tx_tx;
      q(s::y, s::y) += third * thick.ty_ty;
      q(s::x, s::y) += third * thick.tx_ty;
      q(s::x, s::tx) += half * thick.tx_tx;
      q(s::x, s::ty) += half * thick.tx_ty;
      q(s::tx, s::y) += half * thick.tx_ty;
      q(s::y, s::ty) += half * thick.ty_ty;
      q(s::x, s::q_over_pz) += half * thick.tx_k;
      q(s::y, s::q_over_pz) += half * thick.ty_k;
    }
    if (!step.start.empty()) {
      const kick<Scalar> c = scatter(start, crossing, step.start);
      const auto& f = moved.jacobian;
      // F C F' where C has only the rows and columns tx, ty, q/pz.
      for (int i = 0; i < 5; ++i) {
        const Scalar by_tx = f(i, s::tx) * c.tx_tx + f(i, s::ty) * c.tx_ty + f(i, s::q_over_pz) * c.tx_k;
        const Scalar by_ty = f(i, s::tx) * c.tx_ty + f(i, s::ty) * c.ty_ty + f(i, s::q_over_pz) * c.ty_k;
        const Scalar by_k = f(i, s::tx) * c.tx_k + f(i, s::ty) * c.ty_k + f(i, s::q_over_pz) * c.k_k;
        for (int j = i; j < 5; ++j) q(i, j) += by_tx * f(j, s::tx) + by_ty * f(j, s::ty) + by_k * f(j, s::q_over_pz);
      }
    }
    for (int i = 1; i < 5; ++i)
      for (int j = 0; j < i; ++j) q(i, j) = q(j, i);
    return q;
  }

 private:
  /// Upper triangle of the covariance of (tx, ty, q/pz) from material at one place.
  template <class Scalar>
  struct kick {
    Scalar tx_tx, tx_ty, ty_ty, tx_k, ty_k, k_k;
  };

  template <class Scalar, class Stack>
  [[nodiscard]] kick<Scalar> scatter(const vector<Scalar, 5>& at, const crossing_particle<Scalar>& crossing, const Stack& stack) const {
    using s = slope_state;
    const Scalar tx = at[s::tx];
    const Scalar ty = at[s::ty];
    const Scalar k = at[s::q_over_pz];
    const Scalar t2 = tx * tx + ty * ty;
    const auto [angle, energy] = [&]() -> std::pair<Scalar, Scalar> {
      if constexpr (requires { stack.angle_variance(crossing); }) return {stack.angle_variance(crossing), stack.energy_variance(crossing)};
      else return {variance_in_slabs(scattering, crossing, hypothesis, stack), variance_in_slabs(straggling, crossing, hypothesis, stack)};
    }();
    const matrix<Scalar, 2, 2> c = slope_covariance(tx, ty, angle);
    const Scalar along = angle * (Scalar(1.0) + t2) * k;
    // d(q/pz)/dE = -(q/pz)/p dp/dE, dp/dE = E/p = 1/beta.
    const Scalar d_k_d_e2 = k * k * crossing.per_p_beta_squared;
    return {c(0, 0), c(0, 1), c(1, 1), Scalar(along * tx), Scalar(along * ty), Scalar(angle * t2 * k * k + energy * d_k_d_e2)};
  }

  template <class Scalar>
  static void add_kick(matrix<Scalar, 5, 5>& q, const kick<Scalar>& c) {
    using s = slope_state;
    q(s::tx, s::tx) += c.tx_tx;
    q(s::tx, s::ty) += c.tx_ty;
    q(s::ty, s::ty) += c.ty_ty;
    q(s::tx, s::q_over_pz) += c.tx_k;
    q(s::ty, s::q_over_pz) += c.ty_k;
    q(s::q_over_pz, s::q_over_pz) += c.k_k;
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
