// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <cmath>
#include <numbers>

#include <scifi/kalman/measurement.hpp>

#include "laws/measurement_laws.hpp"
#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

namespace {

constexpr double pi = std::numbers::pi;

/// Direction of a point of the plane, in (-pi, pi].
struct bearing {
  double z, sigma;
  double value() const { return z; }
  double covariance() const { return sigma * sigma; }
  template <class Scalar>
  kalman::projected<Scalar, 1, 2> project(const scifi::vector<Scalar, 2>& x) const {
    using std::atan2;
    const Scalar r2 = x(0) * x(0) + x(1) * x(1);
    return {scifi::vector<Scalar, 1>::Constant(atan2(x(1), x(0))), scifi::matrix<Scalar, 1, 2>(Scalar(-x(1) / r2), Scalar(x(0) / r2))};
  }
  double residual(double value, double expected) const { return std::remainder(value - expected, 2.0 * pi); }
};

}  // namespace

TEST_CASE("a linear measurement is compared by value minus H x", "[kalman]") {
  const auto seen = kalman::compare(models::position{3.0, 0.5}, scifi::vector<double, 2>(1.0, 10.0));
  CHECK(seen.residual(0) == 2.0);
  CHECK(seen.covariance(0, 0) == 0.25);
  CHECK(seen.jacobian == Eigen::RowVector2d(1.0, 0.0));
}

TEST_CASE("a measurement's own residual is used, for angles that wrap", "[kalman]") {
  const double angle = pi - 0.1;
  const scifi::vector<double, 2> x(std::cos(angle), std::sin(angle));
  const auto seen = kalman::compare(bearing{-pi + 0.1, 0.01}, x);
  CHECK(seen.residual(0) == Approx(0.2).epsilon(1e-12));
}

TEST_CASE("the tangent of a measurement has its residual and falls off with H", "[kalman]") {
  const scifi::vector<double, 2> about(3.0, 4.0), x(3.1, 3.8);
  const bearing m{1.0, 0.01};
  const auto tangent = kalman::linearise(m, about);
  const auto at = kalman::compare(m, about);
  CHECK(kalman::compare(tangent, about).residual(0) == Approx(at.residual(0)).epsilon(1e-14));
  CHECK(kalman::compare(tangent, x).residual(0) == Approx(at.residual(0) - (at.jacobian * (x - about))(0)).epsilon(1e-13));
  CHECK(laws::measurement_jacobian_deviation(m, about, 1e-4) < 1e-8);
}

TEST_CASE("the largest dimension of a measurement is known at compile time", "[kalman]") {
  using three = models::linear_values<2, 3>;
  STATIC_REQUIRE(kalman::max_measurement_dimension<models::position> == 1);
  STATIC_REQUIRE(kalman::max_measurement_dimension<kalman::no_measurement> == 0);
  STATIC_REQUIRE(kalman::max_measurement_dimension<std::variant<models::position, three>> == 3);
  STATIC_REQUIRE(kalman::max_measurement_dimension<std::optional<std::variant<kalman::no_measurement, three>>> == 3);
  STATIC_REQUIRE(kalman::mixed_measurement<std::optional<models::position>>);
  STATIC_REQUIRE_FALSE(kalman::mixed_measurement<models::position>);
}

TEST_CASE("values in double serve an estimate in float", "[kalman]") {
  const auto seen = kalman::compare(models::position{3.0, 0.5}, scifi::vector<float, 2>(1.0F, 10.0F));
  STATIC_REQUIRE(std::is_same_v<std::remove_const_t<decltype(seen)>, kalman::innovation<float, 2, 1>>);
  CHECK(seen.residual(0) == 2.0F);
}
