// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <cmath>

#include <scifi/kalman/automatic_jacobian.hpp>
#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/residual.hpp>

#include "laws/propagator_laws.hpp"

namespace kalman = scifi::kalman;

namespace {

struct slopes {};

/// A turn at constant speed: x, y, direction, curvature.
struct turn {
  using state_space = slopes;
  template <class Scalar>
  scifi::vector<Scalar, 4> operator()(const scifi::vector<Scalar, 4>& x, double s) const {
    using std::cos;
    using std::sin;
    const Scalar angle = x(2) + x(3) * s;
    scifi::vector<Scalar, 4> end;
    end(0) = x(0) + (sin(angle) - sin(x(2))) / x(3);
    end(1) = x(1) - (cos(angle) - cos(x(2))) / x(3);
    end(2) = angle;
    end(3) = x(3);
    return end;
  }
};

}  // namespace

TEST_CASE("the Jacobian by dual numbers is the one written by hand", "[kalman]") {
  const kalman::automatic_jacobian p{turn{}};
  const scifi::vector<double, 4> x(1.0, 2.0, 0.3, 0.4);
  const double s = 1.5, a = x(2) + x(3) * s, k = x(3);
  const auto moved = p.propagate(x, s);
  CHECK((moved.state - turn{}(x, s)).norm() < 1e-14);
  CHECK(moved.jacobian(0, 2) == Approx((std::cos(a) - std::cos(x(2))) / k).epsilon(1e-14));
  CHECK(moved.jacobian(1, 2) == Approx((std::sin(a) - std::sin(x(2))) / k).epsilon(1e-14));
  CHECK(moved.jacobian(0, 3) == Approx(s * std::cos(a) / k - (std::sin(a) - std::sin(x(2))) / (k * k)).epsilon(1e-13));
  CHECK(moved.jacobian(2, 3) == s);
  CHECK(laws::propagator_jacobian_deviation(p, x, s, 1e-4) < 1e-7);
  CHECK(laws::round_trip_deviation(p, x, s, -s) < 1e-14);
}

TEST_CASE("a wrapped callable is a propagator in float and double and keeps its state space", "[kalman]") {
  using wrapped = kalman::automatic_jacobian<turn>;
  STATIC_REQUIRE(kalman::propagator<wrapped, double, 4, double>);
  STATIC_REQUIRE(kalman::propagator<wrapped, float, 4, double>);
  STATIC_REQUIRE(std::is_same_v<kalman::detail::state_space_of<wrapped>::type, slopes>);
  const kalman::estimate<double, 4> start{{1.0, 2.0, 0.3, 0.4}, scifi::matrix<double, 4, 4>::Identity()};
  const auto p = kalman::filter{wrapped{}, kalman::no_noise{}}.predict(start, 1.5);
  CHECK((p.estimate.covariance - p.jacobian * p.jacobian.transpose()).norm() < 1e-13);
}

namespace {

/// Range and bearing, the bearing the short way round; `expected` is all that is said of the geometry.
struct radar {
  using state_space = slopes;
  scifi::vector<double, 2> seen;
  scifi::vector<double, 2> value() const { return seen; }
  scifi::matrix<double, 2, 2> covariance() const { return 0.01 * scifi::matrix<double, 2, 2>::Identity(); }
  template <class Scalar>
  scifi::vector<Scalar, 2> expected(const scifi::vector<Scalar, 4>& x) const {
    using std::atan2, std::sqrt;
    return {sqrt(x(0) * x(0) + x(1) * x(1)), atan2(x(1), x(0))};
  }
  scifi::vector<double, 2> residual(const scifi::vector<double, 2>& measured, const scifi::vector<double, 2>& expected) const {
    return {measured(0) - expected(0), std::remainder(measured(1) - expected(1), 2.0 * std::acos(-1.0))};
  }
};

/// A number, from a function that returns an expression of dual numbers.
struct shadow {
  double length;
  double value() const { return length; }
  double covariance() const { return 1e-4; }
  template <class Scalar>
  auto expected(const scifi::vector<Scalar, 2>& x) const {
    using std::sin;
    return Scalar(2.0 * sin(x(0)));
  }
};

}  // namespace

TEST_CASE("a measurement that says only what it expects gets its Jacobian by dual numbers", "[kalman]") {
  const kalman::automatic_projection m{radar{{5.0, 3.1}}};
  STATIC_REQUIRE(kalman::measurement<std::remove_const_t<decltype(m)>, double, 4>);
  STATIC_REQUIRE(std::is_same_v<kalman::detail::state_space_of<kalman::automatic_projection<radar>>::type, slopes>);
  const scifi::vector<double, 4> x(-3.0, -4.0, 0.3, 0.4);
  const auto seen = m.project(x);
  CHECK(seen.value(0) == Approx(5.0).epsilon(1e-15));
  // d range = (x, y)/range, d bearing = (-y, x)/range^2.
  scifi::matrix<double, 2, 4> by_hand;
  by_hand << -0.6, -0.8, 0.0, 0.0, 0.16, -0.12, 0.0, 0.0;
  CHECK((seen.jacobian - by_hand).norm() < 1e-15);
  // The bearing is -pi + atan(4/3); the difference to 3.1 is taken the short way round.
  CHECK(kalman::compare(m, x).residual(1) == Approx(3.1 - std::acos(-1.0) - std::atan(4.0 / 3.0)).epsilon(1e-13));
}

TEST_CASE("a filter takes a measurement of one number with its Jacobian by dual numbers", "[kalman]") {
  const auto prior = kalman::uncorrelated(scifi::vector<double, 2>(0.3, 0.0), scifi::vector<double, 2>(0.1, 0.1));
  const kalman::filter f{kalman::automatic_jacobian{[](const auto& x, double) { return x; }}, kalman::no_noise{}};
  const auto after = f.update(f.predict(prior, 1.0), kalman::automatic_projection{shadow{0.7}});
  REQUIRE(after.status.ok());
  // H = 2 cos(0.3), P = 0.01, R = 1e-4.
  const double h = 2.0 * std::cos(0.3), gain = 0.01 * h / (0.01 * h * h + 1e-4);
  CHECK(after.posterior.mean(0) == Approx(0.3 + gain * (0.7 - 2.0 * std::sin(0.3))).epsilon(1e-13));
  CHECK(kalman::pull(after) == Approx((0.7 - 2.0 * std::sin(0.3)) / std::sqrt(0.01 * h * h + 1e-4)).epsilon(1e-13));
}
