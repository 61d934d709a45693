// SPDX-License-Identifier: MPL-2.0
#include <scifi/field/uniform_field.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("a uniform field is the same everywhere, for any scalar", "[field]") {
  const uniform_field field{{0.1, -0.2, 0.9}};
  CHECK(field(vector<double, 3>(0.0, 0.0, 0.0)) == field.value);
  CHECK(field(vector<double, 3>(1e6, -30.0, 7.0)) == field.value);
  CHECK(field(vector<float, 3>(1.0f, 2.0f, 3.0f)) == field.value.cast<float>());
  CHECK(field.with_gradient(vector<double, 3>(1.0, 2.0, 3.0)).gradient.isZero(0.0));
  CHECK(uniform_field{}(vector<double, 3>(1.0, 2.0, 3.0)).isZero(0.0));
}
