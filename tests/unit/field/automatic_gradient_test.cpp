// SPDX-License-Identifier: MPL-2.0
#include <scifi/field/automatic_gradient.hpp>

#include "field_laws.hpp"
#include "support/catch.hpp"

using namespace scifi;

namespace {

/// A quadrupole with a sine along z; of no current and no source to first order only.
struct wavy {
  template <class Scalar>
  vector<Scalar, 3> operator()(const vector<Scalar, 3>& r) const {
    using std::sin;
    const Scalar wave = sin(Scalar(Scalar(0.01) * r.z()));
    return {Scalar(r.y() * wave), Scalar(r.x() * wave), Scalar(r.x() * r.y() * Scalar(0.01))};
  }
};

}  // namespace

TEST_CASE("the gradient from dual numbers is that of finite differences", "[field]") {
  const automatic_gradient field{wavy{}};
  const vector<double, 3> at(3.0, -7.0, 40.0);
  CHECK(field.with_gradient(at).value == wavy{}(at));
  CHECK(field(at) == wavy{}(at));
  // Fourth order with a step of 0.1 against a wave of 100: (0.1/100)^4.
  CHECK((field.with_gradient(at).gradient - test::differences_of(field, at, 0.1).gradient).norm() < 1e-11);
  STATIC_REQUIRE(magnetic_field_with_gradient<automatic_gradient<wavy>>);
  STATIC_REQUIRE(magnetic_field_with_gradient<automatic_gradient<wavy>, float>);
}
