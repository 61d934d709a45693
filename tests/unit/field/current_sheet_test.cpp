// SPDX-License-Identifier: MPL-2.0
#include <scifi/field/current_sheet.hpp>

#include <boost/math/quadrature/gauss.hpp>

#include <cmath>
#include <numbers>

#include <scifi/core/linalg.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

/// Biot and Savart for the loops of a sheet: dB = strength/(4 pi) ds x R / R^3 per length of the sheet, along the ring by the trapezoidal rule, which
/// converges exponentially on a period, along z by Gauss's. Radial and axial field at (r, z).
vector<double, 2> by_loops(const current_sheet& s, double r, double z) {
  constexpr int around = 400;
  const auto of_ring = [&](double at, int component) {
    double sum = 0.0;
    for (int i = 0; i < around; ++i) {
      const double phi = 2.0 * std::numbers::pi * i / around, dz = z - at;
      const double x = r - s.radius * std::cos(phi), y = -s.radius * std::sin(phi);
      const double cube = std::pow(x * x + y * y + dz * dz, 1.5);
      // ds = radius dphi (-sin, cos, 0): (ds x R)_x = cos dz, (ds x R)_z = -sin y - cos x.
      sum += (component == 0 ? std::cos(phi) * dz : -std::sin(phi) * y - std::cos(phi) * x) / cube;
    }
    return s.strength / (4.0 * std::numbers::pi) * sum * s.radius * 2.0 * std::numbers::pi / around;
  };
  using gauss = boost::math::quadrature::gauss<double, 30>;
  return {gauss::integrate([&](double at) { return of_ring(at, 0); }, -s.half_length, s.half_length),
          gauss::integrate([&](double at) { return of_ring(at, 1); }, -s.half_length, s.half_length)};
}

}  // namespace

TEST_CASE("the field of a sheet is the sum of its loops, inside, outside and beyond its ends", "[field]") {
  const current_sheet sheet{260.0, 150.0, 0.9};
  for (const double r : {1e-6, 3.0, 120.0, 180.0, 400.0})
    for (const double z : {0.0, 90.0, -150.0, 700.0}) {
      INFO("r " << r << " z " << z);
      const vector<double, 2> loops = by_loops(sheet, r, z);
      const axial_field<double> got = sheet.at(r, z);
      CHECK(std::abs(got.radial_per_r * r - loops[0]) < 1e-11 * sheet.strength);
      CHECK(std::abs(got.along - loops[1]) < 1e-11 * sheet.strength);
    }
}

TEST_CASE("on the axis of a sheet the field is that of two cosines, and a long one holds its strength", "[field]") {
  const current_sheet sheet{260.0, 150.0, 0.9};
  for (const double z : {0.0, 100.0, -400.0}) {
    // strength/2 (cos a1 + cos a2), angles under which the ends are seen (Jackson, Classical Electrodynamics, problem 5.3).
    const double up = 150.0 - z, down = 150.0 + z;
    const double expected = 0.45 * (up / std::hypot(up, 260.0) + down / std::hypot(down, 260.0));
    CHECK(sheet.at(0.0, z).along == Approx(expected).epsilon(1e-14));
    // div B = 0: Br = -r/2 dBz/dz near the axis.
    const double slope = -0.45 * 260.0 * 260.0 * (std::pow(std::hypot(up, 260.0), -3) - std::pow(std::hypot(down, 260.0), -3));
    CHECK(sheet.at(0.0, z).radial_per_r == Approx(-0.5 * slope).epsilon(1e-13).margin(1e-18));
  }
  const current_sheet longest{100.0, 1e6, 0.9};
  CHECK(longest.at(70.0, 0.0).along == Approx(0.9).epsilon(1e-8));
  CHECK(std::abs(longest.at(170.0, 0.0).along) < 1e-8);
}

TEST_CASE("far away a sheet is a dipole, at any distance", "[field]") {
  const current_sheet sheet{260.0, 150.0, 0.9};
  // The loops, each exact in itself, where double precision leaves them enough; beyond, the law that they follow there.
  for (const double distance : {1e5, 3.9e5, 4.3e5, 1e6}) {
    for (const double cosine : {0.0, 0.3, -0.8, 1.0}) {
      const double r = distance * std::sqrt(1.0 - cosine * cosine), z = distance * cosine;
      const vector<double, 2> loops = by_loops(sheet, r, z);
      const axial_field<double> got = sheet.at(r, z);
      const double size = std::hypot(loops[0], loops[1]);
      INFO("distance " << distance << " cosine " << cosine);
      CHECK(got.radial_per_r * r == Approx(loops[0]).margin(3e-6 * size));
      CHECK(got.along == Approx(loops[1]).margin(3e-6 * size));
    }
  }
  for (const double distance : {1e10, 1e30, 1e90, 1e140}) {
    const axial_field<double> on_axis = sheet.at(0.0, distance), across = sheet.at(distance, 0.0);
    const double moment = sheet.strength * sheet.half_length * sheet.radius * sheet.radius;
    CHECK(on_axis.along == Approx(moment / distance / distance / distance).epsilon(1e-6));
    CHECK(across.along == Approx(-0.5 * moment / distance / distance / distance).epsilon(1e-6));
    CHECK(across.radial_per_r == 0.0);
  }
}
