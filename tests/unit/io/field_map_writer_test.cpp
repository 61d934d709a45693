// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/field_map_writer.hpp>

#include <scifi/field/graded_field.hpp>
#include <scifi/field/tabulate.hpp>
#include <scifi/io/field_map_reader.hpp>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace scifi;
using namespace scifi::test;

TEST_CASE("a map of either kind that is written and read again is the same map", "[io]") {
  const graded_field graded{0.9, 1e-3 / 3.0};
  const grid_axis across{-40.0, 20.0, 5}, along{-1.0 / 3.0, 0.1, 4};
  const field_map round(tabulated(graded, {0.0, 20.0, 4}, along, outside_map::error)), square(tabulated(graded, across, across, along, outside_map::error));
  const temporary_folder folder;
  for (const field_map& map : {round, square}) {
    const std::string text = field_map_to_text(map);
    const field_map again = read_field_map(folder.file("a.map", text), outside_map::error);
    CHECK(again.map().index() == map.map().index());
    const vector<double, 3> at(13.0, -7.0, -0.21);
    CHECK((again(at) - map(at)).norm() < 1e-14);
  }
  CHECK(field_map_to_text(round).starts_with("scifi field map\ngrid cylindrical\nlength mm\nfield T\ncolumns r z br bz\n0 -0.3333333333333333 0 "));
}
