// SPDX-License-Identifier: MPL-2.0
#include <scifi/field/concepts.hpp>

#include <scifi/field/graded_field.hpp>
#include <scifi/field/uniform_field.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("anything that gives three components at a position is a field", "[field]") {
  constexpr auto lambda = [](const vector<double, 3>& r) { return vector<double, 3>(0.0, 0.0, r.z()); };
  struct number {
    double operator()(const vector<double, 3>&) const { return 1.0; }
  };
  STATIC_REQUIRE(magnetic_field<decltype(lambda)>);
  STATIC_REQUIRE_FALSE(magnetic_field<decltype(lambda), float>);
  STATIC_REQUIRE_FALSE(magnetic_field_with_gradient<decltype(lambda)>);
  STATIC_REQUIRE_FALSE(magnetic_field<number>);
  STATIC_REQUIRE_FALSE(magnetic_field<double>);
  STATIC_REQUIRE(magnetic_field_with_gradient<uniform_field>);
  STATIC_REQUIRE(magnetic_field_with_gradient<graded_field, float>);
}
