// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include <array>
#include <cmath>

#include <scifi/core/linalg.hpp>

namespace scifi::test {

/// A particle in space: position (mm), momentum (MeV/c), charge (e). The reference for track models; knows no slopes and no Jacobians.
struct moving {
  vector<double, 3> position;
  vector<double, 3> momentum;
  double charge;
};

/// Error that the integrator allows itself in one step, relative to 1 mm + position and 1 MeV/c + momentum.
inline constexpr double lorentz_tolerance = 1e-13;

/// Integrates dr/dz = p/pz, dp/dz = charge p x B / pz - (p/|p|) |dp/ds| / cos up to `z`: Lorentz force and a loss of momentum per path length.
///
/// `field(position)` gives B in (MeV/c)/(e mm), `loss(p, z)` the momentum lost per mm of path, >= 0 along the flight.
template <class Field, class Loss>
[[nodiscard]] moving carried_to(const moving& start, double z, const Field& field, const Loss& loss) {
  namespace odeint = boost::numeric::odeint;
  using state = std::array<double, 5>;  // x, y, px, py, pz
  const auto rate = [&](const state& here, state& d, double at) {
    const vector<double, 3> p(here[2], here[3], here[4]);
    const vector<double, 3> b = field(vector<double, 3>(here[0], here[1], at));
    const double size = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    const double path = size / std::abs(p[2]);                    // of path per |dz|
    const double along = p[2] > 0.0 ? 1.0 : -1.0;                 // the particle's own dz
    const double braking = along * path * loss(size, at) / size;  // relative loss per dz
    const double turn = start.charge / p[2];
    d[0] = p[0] / p[2];
    d[1] = p[1] / p[2];
    d[2] = turn * (p[1] * b[2] - p[2] * b[1]) - braking * p[0];
    d[3] = turn * (p[2] * b[0] - p[0] * b[2]) - braking * p[1];
    d[4] = turn * (p[0] * b[1] - p[1] * b[0]) - braking * p[2];
  };
  state now{start.position[0], start.position[1], start.momentum[0], start.momentum[1], start.momentum[2]};
  const double from = start.position[2];
  auto stepper = odeint::make_controlled(lorentz_tolerance, lorentz_tolerance, odeint::runge_kutta_fehlberg78<state>());
  if (z != from) odeint::integrate_adaptive(stepper, rate, now, from, z, (z - from) / 16.0);
  return {{now[0], now[1], z}, {now[2], now[3], now[4]}, start.charge};
}

/// The same without material.
template <class Field>
[[nodiscard]] moving carried_to(const moving& start, double z, const Field& field) {
  return carried_to(start, z, field, [](double, double) { return 0.0; });
}

}  // namespace scifi::test
