// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <cmath>

#include <scifi/kalman/automatic_jacobian.hpp>
#include <scifi/kalman/filter.hpp>

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
