// SPDX-License-Identifier: MPL-2.0
#include <scifi/field/coil.hpp>

#include <cmath>
#include <numbers>

#include "support/catch.hpp"

using namespace scifi;

namespace {

constexpr double mu0 = 4.0e-4 * std::numbers::pi;  // T mm / A

coil coil_of(double length, double inner_radius, double thickness, double current_density) {
  return {vector<double, 3>::Zero(), vector<double, 3>::UnitZ(), length, inner_radius, thickness, current_density};
}

}  // namespace

TEST_CASE("a coil's field on its axis is the sum of its loops", "[field]") {
  // Biot-Savart for a loop of radius r at distance u: mu0 I r^2 / (2 (r^2 + u^2)^(3/2)); midpoint rule over the cross-section.
  const coil c = coil_of(110.6, 258.0, 60.9, 124.512);
  constexpr int slices = 400;
  for (const double z : {0.0, 100.0, -750.0}) {
    double sum = 0.0;
    for (int i = 0; i < slices; ++i)
      for (int k = 0; k < slices; ++k) {
        const double r = c.inner_radius + c.thickness * (i + 0.5) / slices;
        const double u = z - c.length * ((k + 0.5) / slices - 0.5);
        const double current = c.current_density * c.length * c.thickness / (slices * slices);
        sum += 0.5 * mu0 * current * r * r / std::pow(r * r + u * u, 1.5);
      }
    // The midpoint rule's error is h^2/24 times the second derivative, of order (thickness / slices / radius)^2 / 24 ~ 1e-8.
    CHECK(field_on_axis(c, z) / units::tesla == Approx(sum).epsilon(1e-7));
  }
}

TEST_CASE("a long thin coil holds mu0 times its current per length", "[field]") {
  CHECK(field_on_axis(coil_of(1e6, 100.0, 1.0, 5.0), 0.0) / units::tesla == Approx(mu0 * 5.0).epsilon(1e-6));
}
