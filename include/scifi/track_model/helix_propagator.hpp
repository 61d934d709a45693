// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>

#include <scifi/core/linalg.hpp>
#include <scifi/core/trigonometry.hpp>
#include <scifi/kalman/concepts.hpp>
#include <scifi/kalman/structure.hpp>
#include <scifi/track_model/helix_state.hpp>
#include <scifi/track_model/slope_state.hpp>

namespace scifi {

/// Exact flight in a uniform field along z, in slopes: the transverse direction turns by -theta, theta = field (q/pz) dz.
///
///   (tx, ty)' = R(-theta) (tx, ty),  x' = x + dz (s1 tx + c1 ty),  y' = y + dz (s1 ty - c1 tx),
///   s1 = sin(theta)/theta, c1 = (1 - cos(theta))/theta,
/// from dtx/dz = +field (q/pz) ty, dty/dz = -field (q/pz) tx (Lorentz force; Jackson, Classical Electrodynamics, 12.2). Any sign of the charge, of the
/// direction of travel, of the field and of dz; the straight line is the limit of zero field or zero q/pz.
struct helix_propagator {
  using state_space = slope_state;
  static constexpr std::array unit_columns{slope_state::x, slope_state::y};
  static constexpr bool keeps_q_over_pz = true;
  double field = 0.0;  ///< Bz in the tracker frame, (MeV/c)/(e mm): B in tesla times units::tesla

  /// State (5, slope_state) after dz (mm, either sign) and its Jacobian d_end_d_start (5 x 5). A number that is not finite passes through.
  template <class Scalar>
  [[nodiscard]] kalman::propagated<Scalar, 5> propagate(const vector<Scalar, 5>& start, double dz) const {
    kalman::propagated<Scalar, 5> end;
    propagate_into(kalman::propagated_view<Scalar, 5>{end.state, end.jacobian}, start, dz);
    return end;
  }

  /// The same, written where it is to stay.
  template <class Scalar>
  [[gnu::always_inline]] kalman::propagated_view<Scalar, 5> propagate_into(const kalman::propagated_view<Scalar, 5>& end, const vector<Scalar, 5>& start, double dz) const {
    using s = slope_state;
    const Scalar length = Scalar(dz);
    const Scalar per_k = Scalar(field * dz);
    const turning<Scalar> t = turning_at(Scalar(per_k * start[s::q_over_pz]));
    const Scalar tx = start[s::tx];
    const Scalar ty = start[s::ty];
    const Scalar tx_end = tx * t.cosine + ty * t.sine;
    const Scalar ty_end = ty * t.cosine - tx * t.sine;

    end.state[s::x] = start[s::x] + length * (t.s1 * tx + t.c1 * ty);
    end.state[s::y] = start[s::y] + length * (t.s1 * ty - t.c1 * tx);
    end.state[s::tx] = tx_end;
    end.state[s::ty] = ty_end;
    end.state[s::q_over_pz] = start[s::q_over_pz];

    auto& j = end.jacobian;
    kalman::detail::set_unit_columns<kalman::detail::bits_of(unit_columns)>(j);
    j(s::q_over_pz, s::tx) = Scalar(0.0);
    j(s::q_over_pz, s::ty) = Scalar(0.0);
    j(s::q_over_pz, s::q_over_pz) = Scalar(1.0);
    j(s::x, s::tx) = length * t.s1;
    j(s::x, s::ty) = length * t.c1;
    j(s::y, s::tx) = -length * t.c1;
    j(s::y, s::ty) = length * t.s1;
    j(s::tx, s::tx) = t.cosine;
    j(s::tx, s::ty) = t.sine;
    j(s::ty, s::tx) = -t.sine;
    j(s::ty, s::ty) = t.cosine;
    j(s::x, s::q_over_pz) = length * per_k * (t.d_s1 * tx + t.d_c1 * ty);
    j(s::y, s::q_over_pz) = length * per_k * (t.d_s1 * ty - t.d_c1 * tx);
    j(s::tx, s::q_over_pz) = per_k * ty_end;
    j(s::ty, s::q_over_pz) = -per_k * tx_end;
    return end;
  }
};

/// The same flight in helix_state (x, px, y, py, q/pz), for a charge of magnitude one: (px, py) turns by -theta and moves (x, y) by its mean over pz.
///
/// `travel` (+1 or -1) is the sign of pz, which q/pz alone does not tell. The derivative in q/pz holds for both signs; q/pz = 0 (infinite pz)
/// is the straight line along z.
struct momentum_helix_propagator {
  using state_space = helix_state;
  static constexpr std::array unit_columns{helix_state::x, helix_state::y};
  double field = 0.0;  ///< Bz in the tracker frame, (MeV/c)/(e mm)
  int travel = 1;

  /// State (5, helix_state) after dz (mm, either sign) and its Jacobian d_end_d_start (5 x 5).
  template <class Scalar>
  [[nodiscard]] kalman::propagated<Scalar, 5> propagate(const vector<Scalar, 5>& start, double dz) const {
    using s = helix_state;
    const Scalar k = start[s::q_over_pz];
    const Scalar signed_length = Scalar(dz * travel);
    const Scalar sign = select(k < Scalar(0.0), Scalar(-1.0), Scalar(1.0));
    const Scalar length_over_pz = signed_length * sign * k;  // dz / pz, since 1/pz = travel |q/pz|
    const Scalar per_k = Scalar(field * dz);
    const turning<Scalar> t = turning_at(Scalar(per_k * k));
    const Scalar px = start[s::px];
    const Scalar py = start[s::py];
    const Scalar px_end = px * t.cosine + py * t.sine;
    const Scalar py_end = py * t.cosine - px * t.sine;
    const Scalar mean_px = t.s1 * px + t.c1 * py;
    const Scalar mean_py = t.s1 * py - t.c1 * px;

    kalman::propagated<Scalar, 5> end;
    end.state[s::x] = start[s::x] + length_over_pz * mean_px;
    end.state[s::y] = start[s::y] + length_over_pz * mean_py;
    end.state[s::px] = px_end;
    end.state[s::py] = py_end;
    end.state[s::q_over_pz] = k;

    auto& j = end.jacobian;
    j.setIdentity();
    j(s::x, s::px) = length_over_pz * t.s1;
    j(s::x, s::py) = length_over_pz * t.c1;
    j(s::y, s::px) = -length_over_pz * t.c1;
    j(s::y, s::py) = length_over_pz * t.s1;
    j(s::px, s::px) = t.cosine;
    j(s::px, s::py) = t.sine;
    j(s::py, s::px) = -t.sine;
    j(s::py, s::py) = t.cosine;
    j(s::x, s::q_over_pz) = signed_length * sign * mean_px + length_over_pz * per_k * (t.d_s1 * px + t.d_c1 * py);
    j(s::y, s::q_over_pz) = signed_length * sign * mean_py + length_over_pz * per_k * (t.d_s1 * py - t.d_c1 * px);
    j(s::px, s::q_over_pz) = per_k * py_end;
    j(s::py, s::q_over_pz) = -per_k * px_end;
    return end;
  }
};

}  // namespace scifi
