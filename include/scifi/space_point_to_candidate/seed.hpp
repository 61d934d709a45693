// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/arc/arc_fit.hpp>
#include <scifi/kalman/estimate.hpp>
#include <scifi/track_model/slope_state.hpp>

namespace scifi {

/// The arc fit's state at its last point as slope_state (tracker frame), for a q/pz known from elsewhere, with variance zero.
[[nodiscard]] inline kalman::estimate<double, 5> seed_of_line(const arc_fit& fit, double q_over_pz) {
  using s = slope_state;
  kalman::estimate<double, 5> seed;
  seed.mean << fit.position().x, fit.slope().x, fit.position().y, fit.slope().y, q_over_pz;
  auto& v = seed.covariance;
  v.setZero();
  v(s::x, s::x) = v(s::y, s::y) = fit.position_variance();
  v(s::tx, s::tx) = v(s::ty, s::ty) = fit.slope_variance();
  // E dp conj(ds) = a + ib: x goes with tx as y with ty (a), y with tx as x against ty (b).
  const planar<double> ps = fit.position_slope_covariance();
  v(s::x, s::tx) = v(s::tx, s::x) = v(s::y, s::ty) = v(s::ty, s::y) = ps.x;
  v(s::y, s::tx) = v(s::tx, s::y) = ps.y;
  v(s::x, s::ty) = v(s::ty, s::x) = -ps.y;
  return seed;
}

/// The same with q/pz = curvature / field and its uncertainty, which moves the whole state. `field` in (MeV/c)/(e mm), not zero.
[[nodiscard]] inline kalman::estimate<double, 5> seed_of_helix(const arc_fit& fit, double field) {
  kalman::estimate<double, 5> seed = seed_of_line(fit, fit.curvature() / field);
  vector<double, 5> d_curvature;
  d_curvature << fit.d_position().x, fit.d_slope().x, fit.d_position().y, fit.d_slope().y, 1.0 / field;
  seed.covariance.noalias() += fit.curvature_variance() * d_curvature * d_curvature.transpose();
  return seed;
}

}  // namespace scifi
