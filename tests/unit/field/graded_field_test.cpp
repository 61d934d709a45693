// SPDX-License-Identifier: MPL-2.0
#include <scifi/field/graded_field.hpp>

#include "field_laws.hpp"
#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("a graded field has its value and growth on the axis and no sources or currents anywhere", "[field]") {
  const graded_field field{0.9, 3e-4};
  CHECK(field(vector<double, 3>(0.0, 0.0, 100.0)) == vector<double, 3>(0.0, 0.0, 0.9 + 3e-2));
  for (const vector<double, 3>& at : {vector<double, 3>(0.0, 0.0, 0.0), vector<double, 3>(40.0, -70.0, 350.0)}) {
    const test::differences found = test::differences_of(field, at, 1.0);
    CHECK(std::abs(found.divergence()) < 1e-15);
    CHECK(found.curl().norm() < 1e-15);
    CHECK((field.with_gradient(at).gradient - found.gradient).norm() < 1e-14);
    CHECK(field.with_gradient(at).value == field(at));
  }
}
