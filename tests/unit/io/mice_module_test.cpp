// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/mice_module.hpp>

#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace scifi::test;
using scifi::input_error;
using scifi::mice_module;
using scifi::mice_property;
using scifi::mice_quantity;

namespace {

mice_property property(std::vector<std::string> words) { return {"PropertyDouble", "Pitch", "f.dat", 7, std::move(words)}; }

}  // namespace

TEST_CASE("units belong to one quantity", "[io]") {
  CHECK(scifi::mice_unit(mice_quantity::length, "cm") == 10.0);
  CHECK(scifi::mice_unit(mice_quantity::length, "m") == 1000.0);
  CHECK(*scifi::mice_unit(mice_quantity::angle, "degree") * 180.0 == Approx(3.14159265358979));
  CHECK(scifi::mice_unit(mice_quantity::field, "tesla") == 0.299792458);
  CHECK_FALSE(scifi::mice_unit(mice_quantity::length, "degree"));
  CHECK_FALSE(scifi::mice_unit(mice_quantity::angle, "mm"));
  CHECK_FALSE(scifi::mice_unit(mice_quantity::field, "Mm"));
}

TEST_CASE("a property is read as what it is asked for", "[io]") {
  CHECK(property({"0.05", "cm"}).positive_length() == Approx(0.5));
  CHECK(property({"106.5"}).number() == 106.5);
  CHECK(property({"2"}).whole_number(0, 3) == 2);
  CHECK(property({"He"}).text() == "He");
  CHECK(property({"1", "2", "3", "m"}).quantities(mice_quantity::length, 3) == std::vector<double>{1000.0, 2000.0, 3000.0});
}

TEST_CASE("a property that is not what it is asked for names file, line and reason", "[io]") {
  const auto message = [](const auto& action) { return without("f.dat:7: PropertyDouble Pitch: ", message_of<input_error>(action)); };
  CHECK(message([] { (void)property({}).number(); }) == "the line is too short: it needs a number");
  CHECK(message([] { (void)property({"1", "mm"}).number(); }) == "is not one number without a unit");
  CHECK(message([] { (void)property({"1.5"}).whole_number(0, 3); }) == "'1.5' is not a whole number");
  CHECK(message([] { (void)property({"4"}).whole_number(0, 3); }) == "'4' is outside 0 .. 3");
  CHECK(message([] { (void)property({"1e300"}).whole_number(0, 3); }) == "'1e300' is outside 0 .. 3");
  CHECK(message([] { (void)property({"a", "b"}).text(); }) == "is not one word");
  CHECK(message([] { (void)property({"0.4"}).positive_length(); }) == "is without a unit");
  CHECK(message([] { (void)property({"mm"}).positive_length(); }) == "the line is too short: it needs 1 number and a unit");
  CHECK(message([] { (void)property({"0.4", "tesla"}).positive_length(); }) == "'tesla' is not a unit of length (um, mm, cm, m)");
  CHECK(message([] { (void)property({"-0.4", "mm"}).positive_length(); }) == "'-0.4' is not above zero");
  CHECK(message([] { (void)property({"0.4", "mm", "5"}).positive_length(); }) == "the line is too long: '5' is not expected");
  CHECK(message([] { (void)property({"x", "mm"}).positive_length(); }) == "'x' is not a number");
  CHECK(message([] { (void)property({"1", "2", "mm"}).quantities(mice_quantity::length, 3); }) == "the line is too short: it needs 3 numbers and a unit");
  CHECK(message([] { (void)property({"1", "mm"}).quantities(mice_quantity::angle, 1); }) == "'mm' is not a unit of angle (degree, mrad, rad)");
  CHECK(message([] { (void)property({"1", "mm"}).quantities(mice_quantity::field, 1); }) == "'mm' is not a unit of the field (tesla)");
}

TEST_CASE("a property that a module does not have is named with the module", "[io]") {
  mice_module m;
  m.name = "Plane";
  m.file = "g.dat";
  m.line = 3;
  m.properties.emplace("Pitch", property({"1", "mm"}));
  CHECK(m.find("Pitch") == &m.at("Pitch"));
  CHECK(m.find("pitch") == nullptr);
  CHECK_FALSE(m.has("Pitch", "1"));
  CHECK(message_of<input_error>([&] { (void)m.at("CentralFibre"); }) == "g.dat:3: Module Plane: has no property CentralFibre");
}
