// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/mice_placed.hpp>

#include <cmath>
#include <string>

#include <scifi/io/mice_module_reader.hpp>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace scifi::test;
using scifi::input_error;
using scifi::mice_module;
using scifi::detail::placed_module;

namespace {

mice_module module_of(const std::string& lines) {
  const temporary_folder folder;
  return scifi::read_mice_modules(folder.file("a.dat", "Module A\n{\n" + lines + "\n}\n"));
}

/// The message without file and line.
template <class Action>
std::string reason(const Action& action) {
  const std::string message = message_of<input_error>(action);
  const std::size_t at = message.find("Module A: ");
  return at == std::string::npos ? message : message.substr(at);
}

}  // namespace

TEST_CASE("positions are in the frame of the module around, however it is turned", "[io]") {
  // A tracker turned round about y, 500 mm upstream, with a station 300 mm along its own z and 2 mm along its own x, turned by 30 degrees.
  const mice_module top = module_of(
      "Position 9 9 9 m\nModule Tracker\n{\nPosition 0 0 -500 mm\nRotation 0 180 0 degree\n"
      "Module Station\n{\nPosition 2 3 300 mm\nRotation 0 0 -30 degree\n}\n}");
  const placed_module tracker = placed_module(top).inside(top.children[0]);
  const placed_module station = tracker.inside(top.children[0].children[0]);
  CHECK((station.origin - scifi::vector<double, 3>(-2.0, 3.0, -800.0)).norm() < 1e-12);
  CHECK(station.around.size() == 2);
  CHECK(station.around[0] == &top);
  const placed_module in_tracker = placed_module(top.children[0]).inside(top.children[0].children[0]);
  CHECK(in_tracker.origin == scifi::vector<double, 3>(2.0, 3.0, 300.0));
  // A rotation by -30 degrees turns the axes by +30.
  CHECK(in_tracker.angle_about_z() == Approx(30.0 * scifi::units::degree));
  CHECK(reason([&] { (void)station.angle_about_z(); }).find("Module Station: is turned about another axis than z") != std::string::npos);
}

TEST_CASE("sums of decimals lose what they did not have", "[io]") {
  CHECK(scifi::detail::rounded(-349.9143 + 549.8789) == 199.9646);
  CHECK(scifi::detail::rounded(549.9026 + 550.0) == 1099.9026);
  CHECK(scifi::detail::rounded(0.1 + 0.2) == 0.3);
  CHECK_FALSE(std::signbit(scifi::detail::rounded(-1e-17)));
}

TEST_CASE("materials and lengths are those of the module", "[io]") {
  const mice_module m = module_of("Volume Cylinder\nDimensions 18.9 0.0025 cm\nPropertyString Material MYLAR");
  CHECK(scifi::detail::medium_of(m).name == "mylar");
  CHECK(scifi::detail::length_of(m) == Approx(0.025));
  CHECK(reason([] { (void)scifi::detail::medium_of(module_of("")); }) == "Module A: has no property Material");
  CHECK(reason([] { (void)scifi::detail::medium_of(module_of("PropertyString Material Unobtainium")); }).find("'Unobtainium' is not known") !=
        std::string::npos);
  CHECK(reason([] { (void)scifi::detail::length_of(module_of("Volume Tube\nDimensions 1 2 3 mm")); }) ==
        "Module A: is not a cylinder with a radius and a length");
  CHECK(reason([] { (void)scifi::detail::length_of(module_of("Volume Cylinder\nDimensions 1 mm")); }) ==
        "Module A: is not a cylinder with a radius and a length");
  CHECK(reason([] { (void)scifi::detail::length_of(module_of("Volume Cylinder\nDimensions 1 0 mm")); }) == "Module A: its length is not above zero");
}

TEST_CASE("views are named as in the papers", "[io]") {
  CHECK(scifi::detail::view_of("TrackerViewV") == "V");
  CHECK(scifi::detail::view_of("TrackerViewX") == "U");
  CHECK(scifi::detail::view_of("Sheet") == "Sheet");
}
