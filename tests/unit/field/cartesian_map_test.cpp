// SPDX-License-Identifier: MPL-2.0
#include <scifi/field/cartesian_map.hpp>

#include <initializer_list>

#include <scifi/field/tabulate.hpp>

#include "field_laws.hpp"
#include "support/catch.hpp"
#include "unit/track_model/dual.hpp"

using namespace scifi;

namespace {

const grid_axis x{-20.0, 8.0, 6}, y{-15.0, 10.0, 4}, z{0.0, 12.0, 5};

/// Free of sources and currents: the gradient of x^2 y - y^3/3 + x z.
struct sextupole {
  template <class Scalar>
  vector<Scalar, 3> operator()(const vector<Scalar, 3>& r) const {
    return {Scalar(Scalar(2.0) * r.x() * r.y() + r.z()), Scalar(r.x() * r.x() - r.y() * r.y()), Scalar(r.x())};
  }
};

}  // namespace

TEST_CASE("a map of parabolas is exact everywhere, and so is its gradient", "[field]") {
  const auto map = tabulated(sextupole{}, x, y, z, outside_map::error);
  for (const vector<double, 3>& at : {vector<double, 3>(-20.0, -15.0, 0.0), vector<double, 3>(20.0, 15.0, 48.0), vector<double, 3>(3.3, -1.0, 20.1)}) {
    CHECK((map(at) - sextupole{}(at)).norm() < 1e-12);
    const test::differences exact = test::differences_of(sextupole{}, at, 1.0);
    CHECK((map.with_gradient(at).gradient - exact.gradient).norm() < 1e-11);
  }
  const vector<double, 3> at(3.3, -1.0, 20.1);
  CHECK((map.with_gradient(at).gradient - test::derivative<3, 3>([&](const auto& v) { return map(v); }, at)).norm() < 1e-13);
}

TEST_CASE("outside of a Cartesian map is what the policy says", "[field]") {
  const vector<double, 3> beyond(3.0, 2.0, 48.5);
  CHECK(tabulated(sextupole{}, x, y, z, outside_map::zero)(beyond).norm() == 0.0);
  CHECK(tabulated(sextupole{}, x, y, z, outside_map::error)(beyond).array().isNaN().all());
  CHECK((tabulated(sextupole{}, x, y, z, outside_map::nearest)(beyond) - sextupole{}(vector<double, 3>(3.0, 2.0, 48.0))).norm() < 1e-12);
}
