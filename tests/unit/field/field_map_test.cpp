// SPDX-License-Identifier: MPL-2.0
#include <scifi/field/field_map.hpp>

#include <scifi/field/graded_field.hpp>
#include <scifi/field/tabulate.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("a field map is the map that it holds", "[field]") {
  const graded_field graded{0.9, 3e-4};
  const grid_axis across{-40.0, 20.0, 5}, along{0.0, 25.0, 5};
  const field_map round(tabulated(graded, {0.0, 20.0, 3}, along, outside_map::error)), square(tabulated(graded, across, across, along, outside_map::error));
  const vector<double, 3> at(13.0, -7.0, 61.0);
  for (const field_map& map : {round, square}) {
    CHECK((map(at) - graded(at)).norm() < 1e-14);
    CHECK((map.with_gradient(at).gradient - graded.with_gradient(at).gradient).norm() < 1e-15);
    CHECK(map(vector<double, 3>(0.0, 0.0, -1.0)).array().isNaN().all());
  }
  STATIC_REQUIRE(magnetic_field_with_gradient<field_map>);
  STATIC_REQUIRE(magnetic_field_with_gradient<field_map, float>);
}
