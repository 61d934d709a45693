// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/linalg.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/kalman/estimate.hpp>
#include <scifi/track_model/helix_state.hpp>
#include <scifi/track_model/line_state.hpp>
#include <scifi/track_model/slope_state.hpp>

/// From one state space to another, with the full Jacobian. All in the tracker frame, mm and MeV/c.
///
/// `travel` is +1 for a particle that moves towards +z and -1 towards -z; the charge has magnitude one, so pz = travel / |q/pz|
/// and charge = travel * sign(q/pz). A state with q/pz = 0 gives infinite momenta: the caller's finiteness check sees them.
namespace scifi {

/// A state in another space and its derivative: `jacobian` (To x From) = d_to_d_from.
template <class Scalar, int To, int From>
struct converted {
  vector<Scalar, To> state;
  matrix<Scalar, To, From> jacobian;
};

/// Moves mean and covariance (J C J') through a conversion.
template <class Scalar, int From, class Conversion>
[[nodiscard]] auto convert(const kalman::estimate<Scalar, From>& e, const Conversion& conversion) {
  const auto c = conversion(e.mean);
  constexpr int To = decltype(c.state)::RowsAtCompileTime;
  const matrix<Scalar, To, To> covariance = c.jacobian * e.covariance * c.jacobian.transpose();
  return kalman::estimate<Scalar, To>{c.state, symmetrised<Scalar, To>(covariance)};
}

/// slope_state -> helix_state: px = tx pz, py = ty pz.
template <class Scalar>
[[nodiscard]] converted<Scalar, 5, 5> slopes_to_helix(const vector<Scalar, 5>& s, int travel) {
  using in = slope_state;
  using out = helix_state;
  const Scalar k = s[in::q_over_pz];
  const Scalar pz = Scalar(double(travel)) / magnitude(k);
  converted<Scalar, 5, 5> c;
  c.state << s[in::x], s[in::tx] * pz, s[in::y], s[in::ty] * pz, k;
  c.jacobian.setIdentity();
  c.jacobian(out::px, in::tx) = pz;
  c.jacobian(out::py, in::ty) = pz;
  c.jacobian(out::px, in::q_over_pz) = -c.state[out::px] / k;
  c.jacobian(out::py, in::q_over_pz) = -c.state[out::py] / k;
  return c;
}

/// helix_state -> slope_state: tx = px / pz, ty = py / pz.
template <class Scalar>
[[nodiscard]] converted<Scalar, 5, 5> helix_to_slopes(const vector<Scalar, 5>& s, int travel) {
  using in = helix_state;
  using out = slope_state;
  const Scalar k = s[in::q_over_pz];
  const Scalar d = Scalar(double(travel));
  const Scalar inverse_pz = d * magnitude(k);
  const Scalar sign = select(k < Scalar(0.0), Scalar(-d), d);
  converted<Scalar, 5, 5> c;
  c.state << s[in::x], s[in::px] * inverse_pz, s[in::y], s[in::py] * inverse_pz, k;
  c.jacobian.setIdentity();
  c.jacobian(out::tx, in::px) = inverse_pz;
  c.jacobian(out::ty, in::py) = inverse_pz;
  c.jacobian(out::tx, in::q_over_pz) = s[in::px] * sign;
  c.jacobian(out::ty, in::q_over_pz) = s[in::py] * sign;
  return c;
}

/// slope_state -> momentum_state (x, y, px, py, pz).
template <class Scalar>
[[nodiscard]] converted<Scalar, 5, 5> slopes_to_momentum(const vector<Scalar, 5>& s, int travel) {
  using in = slope_state;
  using out = momentum_state;
  const Scalar k = s[in::q_over_pz];
  const Scalar pz = Scalar(double(travel)) / magnitude(k);
  converted<Scalar, 5, 5> c;
  c.state << s[in::x], s[in::y], s[in::tx] * pz, s[in::ty] * pz, pz;
  c.jacobian.setZero();
  c.jacobian(out::x, in::x) = Scalar(1.0);
  c.jacobian(out::y, in::y) = Scalar(1.0);
  c.jacobian(out::px, in::tx) = pz;
  c.jacobian(out::py, in::ty) = pz;
  c.jacobian(out::px, in::q_over_pz) = -c.state[out::px] / k;
  c.jacobian(out::py, in::q_over_pz) = -c.state[out::py] / k;
  c.jacobian(out::pz, in::q_over_pz) = -pz / k;
  return c;
}

/// momentum_state (x, y, px, py, pz) of a particle with the sign of charge given -> slope_state.
template <class Scalar>
[[nodiscard]] converted<Scalar, 5, 5> momentum_to_slopes(const vector<Scalar, 5>& s, int charge) {
  using in = momentum_state;
  using out = slope_state;
  const Scalar inverse_pz = Scalar(1.0) / s[in::pz];
  const Scalar q = Scalar(double(charge));
  converted<Scalar, 5, 5> c;
  c.state << s[in::x], s[in::px] * inverse_pz, s[in::y], s[in::py] * inverse_pz, q * inverse_pz;
  c.jacobian.setZero();
  c.jacobian(out::x, in::x) = Scalar(1.0);
  c.jacobian(out::y, in::y) = Scalar(1.0);
  c.jacobian(out::tx, in::px) = inverse_pz;
  c.jacobian(out::ty, in::py) = inverse_pz;
  c.jacobian(out::tx, in::pz) = -c.state[out::tx] * inverse_pz;
  c.jacobian(out::ty, in::pz) = -c.state[out::ty] * inverse_pz;
  c.jacobian(out::q_over_pz, in::pz) = -c.state[out::q_over_pz] * inverse_pz;
  return c;
}

/// slope_state -> line_state: forgets q/pz.
template <class Scalar>
[[nodiscard]] converted<Scalar, 4, 5> slopes_to_line(const vector<Scalar, 5>& s) {
  converted<Scalar, 4, 5> c;
  c.state = s.template head<4>();
  c.jacobian.setIdentity();
  return c;
}

/// line_state and a q/pz that is known from elsewhere -> slope_state; the new row of the Jacobian is zero.
template <class Scalar>
[[nodiscard]] converted<Scalar, 5, 4> line_to_slopes(const vector<Scalar, 4>& s, const Scalar& q_over_pz) {
  converted<Scalar, 5, 4> c;
  c.state << s, q_over_pz;
  c.jacobian.setIdentity();
  return c;
}

}  // namespace scifi
