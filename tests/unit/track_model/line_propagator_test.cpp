// SPDX-License-Identifier: MPL-2.0
#include <scifi/track_model/line_propagator.hpp>

#include <Eigen/LU>

#include <limits>

#include <scifi/track_model/helix_propagator.hpp>

#include "laws/propagator_laws.hpp"
#include "support/catch.hpp"

using ss = scifi::line_state;
using scifi::line_propagator;

TEST_CASE("a straight track moves by its slopes and keeps them", "[track_model]") {
  const scifi::vector<double, 4> start(1.0, 0.25, -2.0, -0.5);
  for (const double dz : {-200.0, 0.0, 8.0}) {
    const auto end = scifi::kalman::propagate(line_propagator{}, start, dz);
    CHECK(end.state[ss::x] == 1.0 + 0.25 * dz);
    CHECK(end.state[ss::y] == -2.0 - 0.5 * dz);
    CHECK(end.state[ss::tx] == 0.25);
    CHECK(end.state[ss::ty] == -0.5);
  }
}

TEST_CASE("straight flights compose, return and keep the volume of phase space", "[track_model]") {
  const scifi::vector<double, 4> start(10.0, 0.3, -20.0, 0.1);
  constexpr double rounding = 8.0 * std::numeric_limits<double>::epsilon();
  CHECK(laws::composition_deviation(line_propagator{}, start, 100.0, 250.0, 350.0) < rounding);
  CHECK(laws::round_trip_deviation(line_propagator{}, start, 350.0, -350.0) < rounding);
  CHECK(line_propagator{}.transition(350.0).determinant() == Approx(1.0).epsilon(1e-12));
}

TEST_CASE("the straight flight is the helix without a field", "[track_model]") {
  const scifi::vector<double, 5> start(10.0, 0.3, -20.0, 0.1, 0.005);
  const auto helix = scifi::helix_propagator{0.0}.propagate(start, 250.0);
  const scifi::vector<double, 4> line = line_propagator{}.transition(250.0) * start.head<4>();
  CHECK((helix.state.head<4>() - line).norm() <= 1e-13);
  CHECK((helix.jacobian.topLeftCorner<4, 4>() - line_propagator{}.transition(250.0)).norm() == 0.0);
}
