// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <cmath>

#include <scifi/kalman/propagation.hpp>

#include "laws/propagator_laws.hpp"
#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

namespace {

/// Logistic growth, x' = x (1 - x), solved in closed form.
struct logistic {
  kalman::propagated<double, 1> propagate(const scifi::vector<double, 1>& x, double t) const {
    const double e = std::exp(t), d = 1.0 + x(0) * (e - 1.0);
    return {scifi::vector<double, 1>::Constant(x(0) * e / d), scifi::matrix<double, 1, 1>::Constant(e / (d * d))};
  }
};

}  // namespace

TEST_CASE("a linear propagator gives F x and F", "[kalman]") {
  const auto moved = kalman::propagate(models::constant_velocity{}, scifi::vector<double, 2>(1.0, 2.0), 3.0);
  CHECK(moved.state == Eigen::Vector2d(7.0, 2.0));
  CHECK(moved.jacobian(0, 1) == 3.0);
}

TEST_CASE("both forms of propagator pass the laws", "[kalman]") {
  const scifi::vector<double, 2> x(1.0, 2.0);
  CHECK(laws::round_trip_deviation(models::constant_velocity{}, x, 0.7, -0.7) < 1e-15);
  CHECK(laws::composition_deviation(models::constant_velocity{}, x, 0.25, 0.5, 0.75) < 1e-15);
  CHECK(laws::propagator_jacobian_deviation(models::constant_velocity{}, x, 0.7, 1e-3) < 1e-12);
  const scifi::vector<double, 1> y = scifi::vector<double, 1>::Constant(0.2);
  CHECK(laws::round_trip_deviation(logistic{}, y, 0.7, -0.7) < 1e-15);
  CHECK(laws::composition_deviation(logistic{}, y, 0.25, 0.5, 0.75) < 1e-15);
  // Central differences err by h^2 f'''/6 and eps/h.
  CHECK(laws::propagator_jacobian_deviation(logistic{}, y, 0.7, 1e-4) < 1e-7);
}
