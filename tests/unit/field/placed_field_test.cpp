// SPDX-License-Identifier: MPL-2.0
#include <scifi/field/placed_field.hpp>

#include <Eigen/Geometry>

#include <scifi/field/coil_field.hpp>
#include <scifi/field/graded_field.hpp>

#include "field_laws.hpp"
#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("coils seen from another frame are the coils placed in that frame", "[field]") {
  const matrix<double, 3, 3> turn = Eigen::AngleAxisd(2.1, vector<double, 3>(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  const vector<double, 3> origin(100.0, -40.0, 700.0);
  const coil inner{{10.0, 20.0, 30.0}, vector<double, 3>::UnitZ(), 100.0, 250.0, 50.0, 100.0};
  coil outer = inner;
  outer.centre = turn.transpose() * (inner.centre - origin);
  outer.axis = turn.transpose() * inner.axis;
  const placed_field seen{coil_field({inner}), turn, origin};
  const vector<double, 3> at(-30.0, 55.0, -600.0);
  CHECK((seen(at) - coil_field({outer})(at)).norm() < 1e-14);
}

TEST_CASE("the gradient of a placed field is the derivative of its value", "[field]") {
  const matrix<double, 3, 3> turn = Eigen::AngleAxisd(0.4, vector<double, 3>(1.0, 1.0, 0.5).normalized()).toRotationMatrix();
  const placed_field seen{graded_field{0.9, 3e-4}, turn, vector<double, 3>(1.0, 2.0, 3.0)};
  const vector<double, 3> at(-30.0, 55.0, -600.0);
  CHECK((seen.with_gradient(at).gradient - test::differences_of(seen, at, 1.0).gradient).norm() < 1e-14);
  CHECK(seen.with_gradient(at).value == seen(at));
  STATIC_REQUIRE(magnetic_field_with_gradient<placed_field<graded_field>>);
  STATIC_REQUIRE_FALSE(magnetic_field_with_gradient<placed_field<coil_field>>);
}
