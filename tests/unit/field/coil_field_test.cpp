// SPDX-License-Identifier: MPL-2.0
#include <scifi/field/coil_field.hpp>

#include <Eigen/Geometry>

#include <boost/math/quadrature/gauss.hpp>

#include <cmath>
#include <numbers>
#include <vector>

#include <scifi/field/automatic_gradient.hpp>

#include "field_laws.hpp"
#include "support/catch.hpp"

using namespace scifi;

namespace {

const coil centred{vector<double, 3>::Zero(), vector<double, 3>::UnitZ(), 110.6, 258.0, 60.9, 124.512};
const coil aside{vector<double, 3>(10.0, -20.0, 700.0), vector<double, 3>(1.0, 2.0, 20.0).normalized(), 300.0, 240.0, 30.0, -90.0};

/// Biot and Savart over the winding of a coil, in its own frame.
vector<double, 3> by_loops(const coil& c, const vector<double, 3>& position) {
  constexpr int around = 300;
  using gauss = boost::math::quadrature::gauss<double, 15>;
  const vector<double, 3> e1 = c.axis.unitOrthogonal(), e2 = c.axis.cross(e1);
  vector<double, 3> sum = vector<double, 3>::Zero();
  for (int i = 0; i < around; ++i) {
    const double phi = 2.0 * std::numbers::pi * i / around;
    const vector<double, 3> out = std::cos(phi) * e1 + std::sin(phi) * e2, along = c.axis.cross(out);
    for (int k = 0; k < 3; ++k)
      sum[k] += gauss::integrate(
          [&](double radius) {
            return gauss::integrate(
                [&](double z) {
                  const vector<double, 3> to = position - c.centre - radius * out - z * c.axis;
                  return radius * along.cross(to)[k] / std::pow(to.norm(), 3);
                },
                -0.5 * c.length, 0.5 * c.length);
          },
          c.inner_radius, c.inner_radius + c.thickness);
  }
  return magnetic_constant / (4.0 * std::numbers::pi) * c.current_density * 2.0 * std::numbers::pi / around * sum;
}

}  // namespace

TEST_CASE("five sheets are the thick coil on its axis, against the closed form", "[field]") {
  const coil_field field({centred});
  for (const double z : {0.0, 55.3, -200.0, 900.0}) {
    const vector<double, 3> b = field(vector<double, 3>(0.0, 0.0, z));
    CHECK(b.z() == Approx(field_on_axis(centred, z)).epsilon(1e-11));
    CHECK(b.head<2>().norm() == 0.0);
  }
}

TEST_CASE("the field of coils anywhere is the sum over their loops", "[field]") {
  const coil_field field({centred, aside});
  for (const vector<double, 3>& at : {vector<double, 3>(0.0, 0.0, 0.0), vector<double, 3>(100.0, -120.0, 40.0), vector<double, 3>(-30.0, 60.0, 650.0),
                                      vector<double, 3>(160.0, 0.0, 55.0), vector<double, 3>(420.0, 100.0, 300.0)}) {
    const vector<double, 3> loops = by_loops(centred, at) + by_loops(aside, at);
    CHECK((field(at) - loops).norm() < 1e-8 * loops.norm());
  }
}

TEST_CASE("outside of the windings the field of coils has neither sources nor currents", "[field]") {
  const coil_field field({centred, aside});
  const automatic_gradient with{field};
  for (const vector<double, 3>& at : {vector<double, 3>(0.0, 0.0, 0.0), vector<double, 3>(100.0, -120.0, 40.0), vector<double, 3>(-30.0, 60.0, 650.0), vector<double, 3>(1e-9, 0.0, 90.0)}) {
    const auto exact = with.with_gradient(at);
    CHECK(exact.value == with(at));
    const double scale = exact.gradient.norm();
    CHECK(std::abs(exact.gradient.trace()) < 1e-11 * scale);
    CHECK((exact.gradient - exact.gradient.transpose()).norm() < 1e-11 * scale);
    // A step of 1 mm against lengths of 100 mm: h^4 (B/L^5)/30 and rounding over h.
    CHECK((exact.gradient - test::differences_of(field, at, 1.0).gradient).norm() < 1e-8 * scale);
  }
}

TEST_CASE("coils add up, and a turned current turns the field", "[field]") {
  coil reversed = centred;
  reversed.axis = -reversed.axis;
  const vector<double, 3> at(30.0, -70.0, 90.0);
  CHECK(coil_field({centred, reversed})(at).norm() < 1e-15);
  CHECK(coil_field(std::vector<coil>{})(at).norm() == 0.0);
}
