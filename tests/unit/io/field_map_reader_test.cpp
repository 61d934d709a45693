// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/field_map_reader.hpp>

#include <cmath>
#include <string>

#include <scifi/field/coil_field.hpp>
#include <scifi/field/tabulate.hpp>
#include <scifi/io/field_map_writer.hpp>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace scifi;
using namespace scifi::test;

namespace {

const coil_field solenoid({{vector<double, 3>::Zero(), vector<double, 3>::UnitZ(), 600.0, 258.0, 40.0, 110.0}});
const std::string header = "scifi field map\ngrid cylindrical\nlength mm\nfield T\n";

/// r and z of 0, 10, 20 in a field of 3 T.
std::string points() {
  std::string out;
  for (const char* r : {"0 ", "10 ", "20 "})
    for (const char* z : {"0 ", "10 ", "20 "}) out += std::string(r) + z + "0 3\n";
  return out;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

}  // namespace

TEST_CASE("a cylindrical map, plain and gzip, is the field it was made of; half of it with its mirror too", "[io]") {
  const temporary_folder folder;
  const auto made = tabulated(solenoid, {0.0, 20.0, 9}, {-400.0, 20.0, 41}, outside_map::error);
  const std::string text = field_map_to_text(made);
  std::string half = header + "mirror z br odd bz even\ncolumns r z br bz\n";
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t k = 20; k < 41; ++k) detail::append_row(half, made.r().at(i), made.z().at(k), made.at(i, k)[0] / units::tesla, made.at(i, k)[1] / units::tesla);
  for (const auto& path : {folder.file("a.map", text), folder.file("b.map.gz", gzip(text)), folder.file("c.map", half)}) {
    const field_map map = read_field_map(path, outside_map::zero);
    for (const vector<double, 3>& at : {vector<double, 3>(0.0, 0.0, 0.0), vector<double, 3>(70.0, -90.0, 333.0), vector<double, 3>(-20.0, 3.0, -390.0)}) {
      CHECK((map(at) - made(at)).norm() < 1e-13);
      CHECK((map(at) - solenoid(at)).norm() < 2e-4 * solenoid(vector<double, 3>(0.0, 0.0, 0.0)).norm());
    }
    CHECK(map(vector<double, 3>(0.0, 0.0, 401.0)).norm() == 0.0);
  }
}

TEST_CASE("a Cartesian map of one octant is unfolded by its three mirrors", "[io]") {
  const temporary_folder folder;
  const grid_axis axis{0.0, 25.0, 7};
  const auto octant = tabulated(solenoid, axis, axis, axis, outside_map::error);
  const std::string text = replaced(field_map_to_text(octant), "columns", "mirror x bx odd by even bz even\nmirror y bx even by odd bz even\nmirror z bx odd by odd bz even\ncolumns");
  const field_map map = read_field_map(folder.file("a.map", text), outside_map::error);
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0}) {
        const vector<double, 3> at(60.0 * x, 81.0 * y, 133.0 * z);
        CHECK((map(at) - solenoid(at)).norm() < 1e-3 * solenoid(at).norm());
        CHECK(map(at).x() * x * z > 0.0);
      }
}

TEST_CASE("the policy says what lies outside", "[io]") {
  const temporary_folder folder;
  const auto path = folder.file("a.map", header + "columns r z br bz\n" + points());
  const vector<double, 3> outside(30.0, 0.0, 5.0);
  CHECK(read_field_map(path, outside_map::zero)(outside).norm() == 0.0);
  CHECK(read_field_map(path, outside_map::nearest)(outside).z() == Approx(3.0 * units::tesla));
  CHECK(std::isnan(read_field_map(path, outside_map::error)(outside).z()));
}

TEST_CASE("a malformed field map is refused with file, line, key or column", "[io]") {
  const std::string good = header + "columns r z br bz\n" + points();
  const std::string cartesian = "scifi field map\ngrid cartesian\nlength mm\nfield T\ncolumns x y z bx by bz\n";
  struct row {
    std::string text;
    const char* message;
  };
  const row table[] = {
      {"", ": the file is empty"},
      {"# nothing\n\n", ": the file is empty"},
      {"r,z,br,bz\n0,0,0,3\n", ":1: is not a field map: the first line must read 'scifi field map'"},
      {"scifi field map\ngrid cylindrical\nlength mm\nfield T\n", ": columns: is missing: the file has no points"},
      {header + "columns r z br bz\n", ": the field map has no points"},
      {replaced(good, "grid", "grind"), ":2: 'grind' is no key of a field map: grid, length, field, mirror, columns"},
      {replaced(good, "grid cylindrical\n", ""), ":4: grid: is missing above the columns"},
      {replaced(good, "length mm\n", ""), ":4: length: is missing above the columns"},
      {replaced(good, "field T\n", ""), ":4: field: is missing above the columns"},
      {replaced(good, "cylindrical", "spherical"), ":2: grid: 'spherical' is not known: cylindrical, cartesian"},
      {replaced(good, "mm", "inch"), ":3: length: 'inch' is not known: mm, cm, m"},
      {replaced(good, "field T", "field tesla"), ":4: field: 'tesla' is not known: T, mT, kG, G"},
      {replaced(good, "length mm", "length"), ":3: length: needs one word"},
      {replaced(good, "length mm", "length mm\nlength cm"), ":4: length: is given twice"},
      {replaced(good, "columns", "mirror r br odd bz even\ncolumns"), ":5: mirror: 'r' is not a coordinate that can be mirrored"},
      {replaced(good, "columns", "mirror z br odd\ncolumns"), ":5: mirror: needs a coordinate and, for each component, its name and 'odd' or 'even'"},
      {replaced(good, "columns", "mirror z br odd bx even\ncolumns"), ":5: mirror: 'bx' is not a component of the field"},
      {replaced(good, "columns", "mirror z br odd br even\ncolumns"), ":5: mirror: 'br' is named twice"},
      {replaced(good, "columns", "mirror z br odd bz both\ncolumns"), ":5: mirror: 'both' is neither 'odd' nor 'even'"},
      {replaced(good, "columns", "mirror z br odd bz even\nmirror z br odd bz even\ncolumns"), ":6: mirror: 'z' is mirrored already"},
      {replaced(good, "grid", "mirror z br odd bz even\ngrid"), ":2: mirror: stands before the grid that it mirrors"},
      {replaced(good, "columns", "mirror z br odd bz odd\ncolumns"), ":5: bz: is odd but not zero on the plane of the mirror"},
      {replaced(good, "columns r z br bz", "columns r z br"), ":5: columns: must name 4 columns"},
      {replaced(good, "columns r z br bz", "columns r z bx bz"), ":5: columns: 'bx' is not a column of this grid"},
      {replaced(good, "columns r z br bz", "columns r z bz bz"), ":5: columns: 'bz' is named twice"},
      {replaced(good, "10 20 0 3", "10 20 0"), ":11: 3 numbers where 4 belong"},
      {replaced(good, "10 20 0 3", "10 20 0 3 4"), ":11: 5 numbers where 4 belong"},
      {replaced(good, "10 20 0 3", "10 20 x 3"), ":11: br: 'x' is not a number"},
      {replaced(good, "10 20 0 3", "10 20 0 3T"), ":11: bz: '3T' is not a number"},
      {replaced(good, "10 20 0 3", "10 20 0 nan"), ":11: bz: 'nan' is not a finite number"},
      {replaced(good, "10 20 0 3", "10 20 0 1e999"), ":11: bz: '1e999' is too large or too small for a number"},
      {replaced(good, "10 20 0 3", "10 10 0 3"), ":11: the point of line 10 once more"},
      {replaced(good, "10 20 0 3\n", ""), ": the grid has no point at r = 10 mm, z = 20 mm"},
      {replaced(good, "20 20 0 3\n", ""), ": the grid has no point at r = 20 mm, z = 20 mm"},
      {replaced(replaced(replaced(good, "20 0 0 3", "25 0 0 3"), "20 10 0 3", "25 10 0 3"), "20 20 0 3", "25 20 0 3"),
       ": r: the places are not at equal distances: 10 mm stands where 12.5 mm belongs"},
      {header + "columns r z br bz\n0 0 0 3\n10 0 0 3\n20 0 0 3\n", ": z: has 1 place, a grid needs three or more"},
      {replaced(good, "0 10 0 3", "0 10 1 3"), ": br: is not zero on the axis"},
      {header + "columns z r br bz\n" + points(), "(no error)"},
      {cartesian + "0 0 0 0 0 3\n1 1 1 0 0 3\n2 2 2 0 0 3\n", ": the grid has no point at x = 0 mm, y = 0 mm, z = 1 mm"},
  };
  const temporary_folder folder;
  const auto path = folder / "map.txt";
  for (const row& r : table) {
    (void)folder.file("map.txt", r.text);
    CHECK(without(path.string(), message_of<input_error>([&path] { (void)read_field_map(path, outside_map::zero); })) == r.message);
  }
  std::string shifted = header + "columns r z br bz\n";
  for (const char* r : {"5 ", "10 ", "15 "})
    for (const char* z : {"0 ", "10 ", "20 "}) shifted += std::string(r) + z + "0 3\n";
  (void)folder.file("map.txt", shifted);
  CHECK(without(path.string(), message_of<input_error>([&path] { (void)read_field_map(path, outside_map::zero); })) == ": r: the grid does not begin with 0");
  (void)folder.file("map.txt", replaced(shifted, "columns", "mirror z br odd bz even\ncolumns"));
  CHECK(message_of<input_error>([&path] { (void)read_field_map(path, outside_map::zero); }) != "(no error)");
  std::string above = replaced(shifted, "columns", "mirror z br odd bz even\ncolumns");
  for (std::size_t at = above.find(" 0 0 3"); at != std::string::npos; at = above.find(" 0 0 3")) above.replace(at, 6, " 30 0 3");
  (void)folder.file("map.txt", above);
  CHECK(without(path.string(), message_of<input_error>([&path] { (void)read_field_map(path, outside_map::zero); })) == ":5: z: is mirrored but its grid neither begins nor ends with 0");

  const std::string packed = gzip(good);
  (void)folder.file("map.txt", packed.substr(0, packed.size() - 12));
  CHECK(message_of<input_error>([&path] { (void)read_field_map(path, outside_map::zero); }).find("the gzip data end too early: the file is truncated") != std::string::npos);
  CHECK(message_of<input_error>([&folder] { (void)read_field_map(folder / "none", outside_map::zero); }).find("cannot be opened") != std::string::npos);
}
