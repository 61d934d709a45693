// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/mice_module_reader.hpp>

#include <cmath>
#include <filesystem>
#include <string>

#include "support/catch.hpp"
#include "support/shared_data.hpp"
#include "support/temporary_folder.hpp"

using namespace scifi::test;
using scifi::input_error;
using scifi::mice_module;

TEST_CASE("modules are nested, in place and from files, and carry what their lines say", "[io]") {
  const temporary_folder folder;
  std::filesystem::create_directory(folder / "Parts");
  folder.file("Parts/Inner.dat", "Module Inner\n{\n  Volume Cylinder\n  Dimensions 1.0 2.0 cm\n  PropertyInt Plane 1\n  PropertyDouble Pitch $P mm\n}\n");
  const auto path = folder.file("top.dat",
                                "Configuration Top\n{\n"
                                "  Substitution $P 0.4\n  Substitution $Coil +2.5\n"
                                "  Module Parts/Inner.dat\n  {\n    Position 0 -1 0.1 m\n    Rotation 0 0 90 degree\n    PropertyInt Plane 2\n  }\n"
                                "  Module Here.dat\n  {\n    Volume None\n    ScaleFactor -$Coil2\n    PropertyString File ${HOME}/a.fld\n  }\n"
                                "  Module Absent.dat { Position 1 2 3 mm }\n}\n// the end\n");
  const mice_module top = scifi::read_mice_modules(path);
  CHECK(top.name == "Top");
  REQUIRE(top.children.size() == 3);
  const mice_module& inner = top.children[0];
  CHECK(inner.name == "Inner");
  CHECK(inner.file == path.string());
  CHECK(inner.line == 5);
  CHECK_FALSE(inner.missing);
  CHECK(inner.dimensions == std::vector<double>{10.0, 20.0});
  CHECK(inner.position == scifi::vector<double, 3>(0.0, -1000.0, 100.0));
  CHECK(inner.at("Pitch").positive_length() == 0.4);
  CHECK(std::filesystem::path(inner.at("Pitch").file).filename() == "Inner.dat");
  CHECK(inner.at("Pitch").line == 6);
  CHECK(inner.at("Plane").whole_number(0, 9) == 2);  // the line where the module is placed comes last
  // Text replaces text: $Coil in $Coil2.
  CHECK(top.children[1].scale_factor == -2.52);
  CHECK(top.children[1].at("File").text() == "${HOME}/a.fld");
  CHECK_FALSE(top.children[1].missing);
  CHECK(top.children[2].missing);
  CHECK(top.children[2].position.z() == 3.0);
}

TEST_CASE("rotations are passive, about x, then y, then z", "[io]") {
  const temporary_folder folder;
  const auto matrix_of = [&folder](const std::string& angles) {
    return scifi::read_mice_modules(folder.file("a.dat", "Module A\n{\nRotation " + angles + " degree\n}\n")).parent_to_child;
  };
  const scifi::vector<double, 3> x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  // By hand: a quarter turn by the right-hand rule, and what it does to a vector that does not turn with it.
  CHECK((matrix_of("90 0 0") * y - z).norm() < 1e-15);
  CHECK((matrix_of("0 90 0") * z - x).norm() < 1e-15);
  CHECK((matrix_of("0 0 90") * x - y).norm() < 1e-15);
  CHECK((matrix_of("90 90 0") * y - x).norm() < 1e-15);
  CHECK((matrix_of("0 90 90") * z - y).norm() < 1e-15);
  // To the last bit: a tracker that is turned round is not tilted.
  CHECK(matrix_of("0 180 0") == scifi::matrix<double, 3, 3>(scifi::vector<double, 3>(-1, 1, -1).asDiagonal()));
  // V of the trackers: the fibres, y of the plane, run along (-sqrt(3)/2, -1/2).
  const scifi::vector<double, 3> fibres = matrix_of("0 0 -120").transpose() * y;
  CHECK((fibres - scifi::vector<double, 3>(-0.5 * std::sqrt(3.0), -0.5, 0.0)).norm() < 1e-15);
}

TEST_CASE("malformed modules are refused with file, line and reason", "[io]") {
  struct row {
    const char* content;
    const char* message;
  };
  const row table[] = {
      {"", ": describes no module"},
      {"// nothing\n", ": describes no module"},
      {"{\"format\": 1}\n", ":1: '{\"format\":': a geometry begins with Configuration or Module"},
      {"Module\n{\n}\n", ":1: Module: the line is too short: it needs a name"},
      {"Module A B\n{\n}\n", ":1: Module: the line is too long: 'B' is not expected"},
      {"Module A\nVolume None\n", ":2: Module A: is not followed by {"},
      {"Module A\n", ":1: Module A: is not followed by {"},
      {"Module A\n{\n Module B\n {\n}\n", ":1: Module A: is not closed by }"},
      {"Module A\n{\n}\n}\n", ":4: '}' after the end of the module"},
      {"Module A\n{\n}\nModule B\n", ":4: 'Module' after the end of the module"},
      {"Module A\n{\n {\n}\n", ":3: '{' is not known"},
      {"Module A\n{\n Postion 0 0 0 mm\n}\n", ":3: 'Postion' is not known"},
      {"Module A\n{\n PropertyFloat X 1\n}\n", ":3: 'PropertyFloat' is not known"},
      {"Module A\n{\n Position 0 0 0\n}\n", ":3: Position: is without a unit"},
      {"Module A\n{\n Position 0 0 mm\n}\n", ":3: Position: the line is too short: it needs 3 numbers and a unit"},
      {"Module A\n{\n Position\n}\n", ":3: Position: the line is too short: it needs 3 numbers and a unit"},
      {"Module A\n{\n Position 0 0 0 degree\n}\n", ":3: Position: 'degree' is not a unit of length (um, mm, cm, m)"},
      {"Module A\n{\n Position 0 0 0 mm 5\n}\n", ":3: Position: the line is too long: '5' is not expected"},
      {"Module A\n{\n Position 0 O 0 mm\n}\n", ":3: Position: 'O' is not a number"},
      {"Module A\n{\n Position 0 nan 0 mm\n}\n", ":3: Position: 'nan' is not a number"},
      {"Module A\n{\n Rotation 0 0 0 mm\n}\n", ":3: Rotation: 'mm' is not a unit of angle (degree, mrad, rad)"},
      {"Module A\n{\n Rotation 0 0 0\n}\n", ":3: Rotation: is without a unit"},
      {"Module A\n{\n Dimensions 1 2\n}\n", ":3: Dimensions: is without a unit"},
      {"Module A\n{\n Dimensions\n}\n", ":3: Dimensions: the line is too short: it needs 1 number and a unit"},
      {"Module A\n{\n Dimensions 1 1 1 1 1 1 1 1 1 1 mm\n}\n", ":3: Dimensions: the line is too long"},
      {"Module A\n{\n Volume\n}\n", ":3: Volume: is not one word"},
      {"Module A\n{\n ScaleFactor two\n}\n", ":3: ScaleFactor: 'two' is not a number"},
      {"Module A\n{\n ScaleFactor $I\n}\n", ":3: '$I' has no Substitution"},
      {"Module A\n{\n Substitution $I\n}\n", ":3: Substitution: the line is too short: it needs a name with $ and its text"},
      {"Module A\n{\n Substitution I 1\n}\n", ":3: Substitution: 'I' does not begin with $"},
      {"Module A\n{\n PropertyInt Plane\n}\n", ":3: PropertyInt: the line is too short: it needs a name and a value"},
      {"Module A\n{\n PropertyInt Plane two\n}\n", ":3: PropertyInt Plane: 'two' is not a number"},
      {"Module A\n{\n PropertyDouble Pitch 1 mm x\n}\n", ":3: PropertyDouble: the line is too long: 'x' is not expected"},
      {"Module A\n{\n PropertyHep3Vector B 1 2\n}\n", ":3: PropertyHep3Vector: the line is too short: it needs a name and three numbers"},
      {"Module A\n{\n Module\n {\n }\n}\n", ":3: Module: the line is too short: it needs a name"},
      {"Module A\n{\n Module a.dat\n {\n }\n}\n", ":3: Module a.dat: the file refers to itself: a.dat -> a.dat"},
      {"Module A\n{\n Volume \xc3\xa9\n}\n", ":3: is not ASCII text: it holds the byte 195"},
  };
  const temporary_folder folder;
  for (const row& r : table) {
    INFO(r.content);
    const auto path = folder.file("a.dat", r.content);
    CHECK(without(path.string(), message_of<input_error>([&] { (void)scifi::read_mice_modules(path); })) == r.message);
  }
  CHECK(message_of<input_error>([&] { (void)scifi::read_mice_modules(folder / "none.dat"); }).find("none.dat: cannot be opened") != std::string::npos);
}

TEST_CASE("a word does not grow beyond a line by its substitutions", "[io]") {
  const temporary_folder folder;
  std::string uses;
  for (int i = 0; i < 100; ++i) uses += "$L";
  const auto path = folder.file("a.dat", "Module A\n{\nSubstitution $L " + std::string(1000, '1') + "\nPropertyString P " + uses + "\n}\n");
  CHECK(without(path.string(), message_of<input_error>([&] { (void)scifi::read_mice_modules(path); })) ==
        ":4: its Substitutions make a word of more than 4096 bytes");
}

TEST_CASE("modules that refer to each other in a ring are refused where the ring closes", "[io]") {
  const temporary_folder folder;
  folder.file("b.dat", "Module B\n{\n Module c.dat\n {\n }\n}\n");
  const auto last = folder.file("c.dat", "Module C\n{\n // back to the first\n Module a.dat { }\n}\n");
  const auto path = folder.file("a.dat", "Module A\n{\n Module b.dat\n {\n }\n}\n");
  CHECK(message_of<input_error>([&] { (void)scifi::read_mice_modules(path); }) ==
        last.string() + ":4: Module a.dat: the file refers to itself: a.dat -> b.dat -> c.dat -> a.dat");
}

TEST_CASE("depth and number of modules are bounded", "[io]") {
  const temporary_folder folder;
  std::string deep;
  for (int i = 0; i < 1000; ++i) deep += "Module A {\n";
  CHECK(message_of<input_error>([&] { (void)scifi::read_mice_modules(folder.file("deep.dat", deep)); }).find("modules are nested more than 64 deep") !=
        std::string::npos);
  // Each file places the next one twenty times.
  for (int i = 0; i < 6; ++i) {
    std::string content = "Module A\n{\n";
    for (int k = 0; k < 20; ++k) content += "Module f" + std::to_string(i + 1) + ".dat { }\n";
    folder.file(("f" + std::to_string(i) + ".dat").c_str(), content + "}\n");
  }
  CHECK(message_of<input_error>([&] { (void)scifi::read_mice_modules(folder / "f0.dat"); }).find("more than 100000 modules") != std::string::npos);
}

TEST_CASE("the experiment's files are read whole", "[io]") {
  const auto data = shared_data();
  if (!data) return;
  const mice_module top = scifi::read_mice_modules(*data / "mice" / "geometry" / "Step_4_def_5_2.dat");
  const auto count = [](const auto& self, const mice_module& m) -> int {
    int n = 1;
    for (const mice_module& child : m.children) n += self(self, child);
    return n;
  };
  CHECK(count(count, top) == 198);  // lines that begin with Module, and Configuration
}
