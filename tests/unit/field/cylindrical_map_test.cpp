// SPDX-License-Identifier: MPL-2.0
#include <scifi/field/cylindrical_map.hpp>

#include <cmath>
#include <initializer_list>
#include <stdexcept>

#include <scifi/field/graded_field.hpp>
#include <scifi/field/tabulate.hpp>

#include "field_laws.hpp"
#include "support/catch.hpp"
#include "unit/track_model/dual.hpp"

using namespace scifi;

namespace {

const grid_axis r{0.0, 20.0, 9}, z{-100.0, 25.0, 13};
const graded_field graded{0.9, 4e-4};

const std::vector<vector<double, 3>> places{{0.0, 0.0, 30.0}, {1e-9, 0.0, 10.0}, {0.0, -7.0, -100.0}, {90.0, 111.0, 163.0}, {-160.0, 0.0, 200.0}};

}  // namespace

TEST_CASE("a map of a field that grows evenly is the field, gradient included, on the axis and at the edges", "[field]") {
  const auto cubic = tabulated(graded, r, z, outside_map::error);
  const auto linear = tabulated<linear_interpolation>(graded, r, z, outside_map::error);
  for (const vector<double, 3>& at : places) {
    INFO(at.transpose());
    CHECK((cubic(at) - graded(at)).norm() < 1e-14);
    CHECK((linear(at) - graded(at)).norm() < 1e-14);
    CHECK((cubic.with_gradient(at).gradient - graded.with_gradient(at).gradient).norm() < 1e-15);
    CHECK((linear.with_gradient(at).gradient - graded.with_gradient(at).gradient).norm() < 1e-15);
  }
}

TEST_CASE("the gradient of a map is that of finite differences and of dual numbers", "[field]") {
  std::vector<std::array<double, 2>> values;
  for (std::size_t i = 0; i < r.count; ++i)
    for (std::size_t k = 0; k < z.count; ++k) values.push_back({std::sin(0.02 * r.at(i)) * std::cos(0.03 * z.at(k)), std::exp(-0.01 * r.at(i)) + std::sin(0.02 * z.at(k))});
  const cylindrical_map<> map(r, z, values, outside_map::error);
  for (const vector<double, 3>& at : {vector<double, 3>(33.0, -47.0, 61.0), vector<double, 3>(-5.0, 2.0, -33.0), vector<double, 3>(0.0, 81.0, 130.0)}) {
    // The interpolation is a cubic within the cell: a step of 0.01 of fourth order leaves rounding over the step.
    CHECK((map.with_gradient(at).gradient - test::differences_of(map, at, 0.01).gradient).norm() < 1e-12);
    CHECK((map.with_gradient(at).gradient - test::derivative<3, 3>([&](const auto& v) { return map(v); }, at)).norm() < 1e-14);
  }
}

TEST_CASE("outside of a map is what the policy says", "[field]") {
  const vector<double, 3> beyond(0.0, 170.0, 30.0), behind(10.0, 0.0, -101.0);
  for (const vector<double, 3>& at : {beyond, behind}) {
    CHECK(tabulated(graded, r, z, outside_map::zero)(at).norm() == 0.0);
    CHECK(tabulated(graded, r, z, outside_map::error)(at).array().isNaN().all());
  }
  const auto nearest = tabulated(graded, r, z, outside_map::nearest);
  CHECK((nearest(behind) - graded(vector<double, 3>(10.0, 0.0, -100.0))).norm() < 1e-15);
  CHECK(nearest(beyond).z() == Approx(graded(beyond).z()).epsilon(1e-14));
  CHECK(nearest.with_gradient(behind).gradient(2, 2) == 0.0);
}

TEST_CASE("a map whose radii do not begin with 0, or with a radial field on the axis, is refused", "[field]") {
  std::vector<std::array<double, 2>> values(9, {0.0, 1.0});
  const grid_axis three{0.0, 1.0, 3};
  CHECK_THROWS_AS(cylindrical_map<>(grid_axis{1.0, 1.0, 3}, three, values, outside_map::zero), std::invalid_argument);
  values[1][0] = 0.1;
  CHECK_THROWS_AS(cylindrical_map<>(three, three, values, outside_map::zero), std::invalid_argument);
}
