// SPDX-License-Identifier: MPL-2.0
#include <scifi/field/grid_axis.hpp>

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include <cmath>
#include <limits>

#include "support/catch.hpp"
#include "unit/kalman/lanes.hpp"

using namespace scifi;

TEST_CASE("a coordinate is found in its cell, at both ends too, and beyond them on the edge", "[field]") {
  const grid_axis axis{-10.0, 5.0, 4};
  CHECK(axis.last() == 5.0);
  const auto check = [&axis](double x, std::size_t cell, double fraction, bool inside) {
    INFO(x);
    const auto place = place_on(axis, x);
    CHECK(place.cell == cell);
    CHECK(place.fraction == Approx(fraction).margin(1e-15));
    CHECK(place.inside == inside);
  };
  check(-10.0, 0, 0.0, true);
  check(-9.0, 0, 0.2, true);
  check(-5.0, 1, 0.0, true);
  check(4.0, 2, 0.8, true);
  check(5.0, 2, 1.0, true);
  check(5.0 + 1e-12, 2, 1.0, true);
  check(5.1, 2, 1.0, false);
  check(-10.1, 0, 0.0, false);
  CHECK(std::isnan(place_on(axis, std::numeric_limits<double>::quiet_NaN()).fraction));
}

TEST_CASE("a dual number keeps its derivative within a cell and has none beyond the edge", "[field]") {
  using dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, 1, 1>>;
  const grid_axis axis{-10.0, 5.0, 4};
  CHECK(place_on(axis, dual(1.0, 1, 0)).fraction.derivatives()[0] == Approx(0.2));
  CHECK(place_on(axis, dual(7.0, 1, 0)).fraction.derivatives().isZero(0.0));
  STATIC_REQUIRE(single_number<float>);
  STATIC_REQUIRE(single_number<dual>);
  STATIC_REQUIRE_FALSE(single_number<lanes::pack>);
}
