// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/mice_field.hpp>

#include <cmath>
#include <numbers>
#include <string>

#include <scifi/io/mice_module_reader.hpp>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace scifi::test;
using scifi::mice_coil;
using scifi::mice_module;
using scifi::detail::placed_module;

namespace {

constexpr double mu0 = 4.0e-4 * std::numbers::pi;  // T mm / A

mice_coil coil_of(double length, double inner_radius, double thickness, double current_density) {
  return {scifi::vector<double, 3>::Zero(), scifi::vector<double, 3>::UnitZ(), length, inner_radius, thickness, current_density};
}

mice_module module_of(const std::string& lines) {
  const temporary_folder folder;
  return scifi::read_mice_modules(folder.file("a.dat", "Module A\n{\n" + lines + "\n}\n"));
}

const std::string coil_lines =
    "Module Coil\n{\nPosition 0 0 50 mm\nRotation 0 180 0 degree\nScaleFactor 3\nPropertyString FieldType Solenoid\nPropertyDouble CurrentDensity -2.\n"
    "PropertyDouble Length 100\nPropertyDouble Thickness 2 cm\nPropertyDouble InnerRadius 258.\n}\n";

}  // namespace

TEST_CASE("a coil's field on its axis is the sum of its loops", "[io]") {
  // Biot-Savart for a loop of radius r at distance u: mu0 I r^2 / (2 (r^2 + u^2)^(3/2)); midpoint rule over the cross-section.
  const mice_coil coil = coil_of(110.6, 258.0, 60.9, 124.512);
  constexpr int slices = 400;
  for (const double z : {0.0, 100.0, -750.0}) {
    double sum = 0.0;
    for (int i = 0; i < slices; ++i)
      for (int k = 0; k < slices; ++k) {
        const double r = coil.inner_radius + coil.thickness * (i + 0.5) / slices;
        const double u = z - coil.length * ((k + 0.5) / slices - 0.5);
        const double current = coil.current_density * coil.length * coil.thickness / (slices * slices);
        sum += 0.5 * mu0 * current * r * r / std::pow(r * r + u * u, 1.5);
      }
    // The midpoint rule's error is h^2/24 times the second derivative, of order (thickness / slices / radius)^2 / 24 ~ 1e-8.
    CHECK(scifi::field_on_axis(coil, z) / scifi::units::tesla == Approx(sum).epsilon(1e-7));
  }
}

TEST_CASE("a long thin coil holds mu0 times its current per length", "[io]") {
  CHECK(scifi::field_on_axis(coil_of(1e6, 100.0, 1.0, 5.0), 0.0) / scifi::units::tesla == Approx(mu0 * 5.0).epsilon(1e-6));
}

TEST_CASE("coils are found with their place, direction and current", "[io]") {
  const auto coils = scifi::mice_coils(module_of("ScaleFactor 0.5\n" + coil_lines));
  REQUIRE(coils.size() == 1);
  CHECK(coils[0].centre == scifi::vector<double, 3>(0, 0, 50));
  CHECK(coils[0].axis == scifi::vector<double, 3>(0, 0, -1));
  CHECK(coils[0].length == 100.0);
  CHECK(coils[0].thickness == 20.0);
  CHECK(coils[0].current_density == -3.0);
  const auto message = message_of<scifi::input_error>([] { (void)scifi::mice_coils(module_of("PropertyString FieldType Solenoid")); });
  CHECK(message.find("Module A: has no property Length") != std::string::npos);
}

TEST_CASE("the field of a tracker is in the tracker's frame", "[io]") {
  const mice_module top = module_of(
      coil_lines + "Module Solenoid\n{\nPropertyHep3Vector MagneticField 0 0 -4 tesla\nModule T\n{\nPosition 0 0 60 mm\nRotation 0 180 0 degree\n}\n}");
  const mice_module& solenoid = top.children[1];
  const placed_module tracker = placed_module(top).inside(solenoid).inside(solenoid.children[0]);
  REQUIRE(scifi::detail::declared_field(tracker).has_value());
  CHECK(*scifi::detail::declared_field(tracker) == Approx(4.0 * scifi::units::tesla));
  CHECK_FALSE(scifi::detail::declared_field(placed_module(top)).has_value());
  CHECK_FALSE(scifi::detail::declared_field(placed_module(top).inside(top.children[0])).has_value());
  // The coil, turned round with a negative current, makes a field along +z of the top, -z of the tracker; the tracker's z = 10 is its middle.
  const double mean = scifi::detail::mean_field_on_axis(scifi::mice_coils(top), tracker, 9.999, 10.001);
  CHECK(mean == Approx(-scifi::field_on_axis(coil_of(100.0, 258.0, 20.0, 6.0), 0.0)).epsilon(1e-8));
}
