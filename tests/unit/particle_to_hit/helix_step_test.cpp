// SPDX-License-Identifier: MPL-2.0
#include <scifi/particle_to_hit/helix_step.hpp>

#include <array>
#include <cmath>

#include <scifi/core/units.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

using six = Eigen::Matrix<double, 6, 1>;

/// Motion in time of a charge in a field along z: dr/dt = c p/E, dp/dt = q c (p x B)/E. Fourth-order Runge-Kutta, the oracle.
six rate(const six& y, double energy, double charge, double field) {
  const double per_energy = constants::speed_of_light / energy;
  six d;
  d << y[3] * per_energy, y[4] * per_energy, y[5] * per_energy, charge * field * y[4] * per_energy, -charge * field * y[3] * per_energy, 0.0;
  return d;
}

/// Integrates to the time at which the closed form says it has arrived; `visit` sees each point.
template <class Visit>
six integrated(const moving_particle& start, double duration, double field, Visit visit) {
  constexpr int steps = 4000;
  const double h = duration / steps;
  const double energy = start.energy();
  const double charge = start.hypothesis.charge;
  six y;
  y << start.position, start.momentum;
  visit(y);
  for (int i = 0; i < steps; ++i) {
    const six k1 = rate(y, energy, charge, field);
    const six k2 = rate(y + 0.5 * h * k1, energy, charge, field);
    const six k3 = rate(y + 0.5 * h * k2, energy, charge, field);
    const six k4 = rate(y + h * k3, energy, charge, field);
    y += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    visit(y);
  }
  return y;
}

}  // namespace

TEST_CASE("the helix step agrees with an integration of the Lorentz force, for every sign of charge, field and flight", "[particle_to_hit]") {
  for (const int charge : {1, -1, 2})
    for (const double tesla : {3.0, -4.0, 0.0})
      for (const double pz : {120.0, -200.0}) {
        moving_particle m;
        m.hypothesis = {105.6583755, charge, 0, "toy"};
        m.position = {20.0, -35.0, 100.0};
        m.momentum = {40.0, 25.0, pz};
        m.t = 1.5;
        const double field = tesla * units::tesla;
        moving_particle end = m;
        helix_step(end, pz > 0.0 ? 900.0 : -900.0, field);

        double furthest = 0.0;
        const six y = integrated(m, end.t - m.t, field, [&furthest](const six& at) { furthest = std::max(furthest, std::hypot(at[0], at[1])); });
        CAPTURE(charge, tesla, pz);
        // Runge-Kutta: some 8 rad in 4000 steps leave (h w)^4 / 120 per radian, below 1e-11 of 1000 mm; rounding of 4000 steps 1e-10.
        CHECK((y.head<3>() - end.position).norm() < 1e-7);
        CHECK((y.tail<3>() - end.momentum).norm() < 1e-7);
        CHECK(end.momentum.norm() == Approx(m.momentum.norm()).epsilon(1e-14));
        // The points are 0.25 mm apart on a circle of 15 mm or more: the largest radius lies at most 0.25^2 / 8 / 15 = 0.6 um above the points.
        CHECK(largest_radius(m, end.position.z() - m.position.z(), field) >= furthest - 1e-7);
        CHECK(largest_radius(m, end.position.z() - m.position.z(), field) < furthest + 1e-3);
      }
}

TEST_CASE("a positive charge in a field along +z circles clockwise with radius pt / (q B)", "[particle_to_hit]") {
  moving_particle m;
  m.momentum = {60.0, 0.0, 200.0};
  const double field = 3.0 * units::tesla;
  const double radius = 60.0 / field;
  // A quarter turn takes dz = (pi/2) pz / (q B): from (0, 0) flying along +x to (R, -R) flying along -y.
  helix_step(m, 0.5 * constants::pi * 200.0 / field, field);
  CHECK(m.position.x() == Approx(radius));
  CHECK(m.position.y() == Approx(-radius));
  CHECK(m.momentum.x() == Approx(0.0).margin(1e-12));
  CHECK(m.momentum.y() == Approx(-60.0));
}

TEST_CASE("time runs at the speed of the particle", "[particle_to_hit]") {
  moving_particle m;
  m.hypothesis = {0.0, 1, 0, "massless"};
  m.momentum = {30.0, 40.0, 120.0};  // |p| = 130
  helix_step(m, 1200.0, 0.0);
  CHECK(m.t == Approx(1300.0 / 299.792458));
}
