// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/mice_field.hpp>

#include <string>

#include <scifi/io/mice_module_reader.hpp>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace scifi::test;
using scifi::mice_module;
using scifi::detail::placed_module;

namespace {

scifi::coil coil_of(double length, double inner_radius, double thickness, double current_density) {
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
  // The same coil in a frame about the point (1, 2, 3) of the tracker, which is turned about y.
  const auto seen = scifi::detail::coils_seen_from(scifi::mice_coils(top), tracker, {1.0, 2.0, 3.0});
  REQUIRE(seen.size() == 1);
  CHECK((seen[0].centre - scifi::vector<double, 3>(-1.0, -2.0, 10.0 - 3.0)).norm() < 1e-12);
  CHECK((seen[0].axis - scifi::vector<double, 3>::UnitZ()).norm() < 1e-12);
}
