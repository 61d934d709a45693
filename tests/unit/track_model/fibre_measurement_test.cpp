// SPDX-License-Identifier: MPL-2.0
#include <scifi/track_model/fibre_measurement.hpp>

#include <cmath>

#include <scifi/geometry/mice.hpp>
#include <scifi/geometry/surface.hpp>
#include <scifi/kalman/measurement.hpp>
#include <scifi/track_model/helix_state.hpp>
#include <scifi/track_model/line_state.hpp>
#include <scifi/track_model/slope_state.hpp>

#include "dual.hpp"
#include "support/catch.hpp"

using scifi::fibre_measurement;
using scifi::point_measurement;

namespace {

constexpr double angle = 2.1;
constexpr double offset = -0.37;

template <class StateSpace>
fibre_measurement<StateSpace> fibre(double alpha) {
  return {alpha, 0.16, std::cos(angle), std::sin(angle), offset};
}

/// A state with different numbers in all components.
template <class StateSpace>
scifi::vector<double, StateSpace::dimension> state() {
  scifi::vector<double, StateSpace::dimension> x;
  for (int i = 0; i < StateSpace::dimension; ++i) x[i] = 3.0 - 1.7 * i + 0.01 * i * i;
  return x;
}

}  // namespace

TEMPLATE_TEST_CASE("the row H of a fibre is the derivative of its coordinate", "[track_model]", scifi::slope_state, scifi::line_state, scifi::helix_state) {
  constexpr int N = TestType::dimension;
  const auto alpha_at = [](const auto& v) {
    using number = typename std::decay_t<decltype(v)>::Scalar;
    scifi::vector<number, 1> alpha;
    alpha[0] = v[TestType::x] * number(std::cos(angle)) + v[TestType::y] * number(std::sin(angle)) - number(offset);
    return alpha;
  };
  const scifi::matrix<double, 1, N> expected = scifi::test::derivative<1, N>(alpha_at, state<TestType>());
  CHECK((fibre<TestType>(0.0).projection() - expected).norm() == 0.0);
}

TEMPLATE_TEST_CASE("a state that crosses where the fibre is has no residual", "[track_model]", scifi::slope_state, scifi::line_state, scifi::helix_state) {
  const auto x = state<TestType>();
  const double there = std::cos(angle) * x[TestType::x] + std::sin(angle) * x[TestType::y] - offset;
  const auto seen = scifi::kalman::compare(fibre<TestType>(there + 0.2), x);
  CHECK(seen.residual[0] == Approx(0.2).epsilon(1e-13));
  CHECK(seen.covariance(0, 0) == 0.16);
}

TEST_CASE("a fibre at a surveyed surface sees what the surface says", "[track_model]") {
  const scifi::vector<double, 5> x(12.0, 0.1, -33.0, -0.2, 0.004);
  for (const scifi::surface& at : scifi::surfaces_along(scifi::mice::trackers().trackers[0], -1)) {
    const fibre_measurement<scifi::slope_state> m{at.tracker_to_alpha(12.0, -33.0), 0.16, at.cos_angle, at.sin_angle, at.offset};
    CHECK(std::abs(scifi::kalman::compare(m, x).residual[0]) < 1e-13);
  }
}

TEMPLATE_TEST_CASE("a point measures x and y and nothing else", "[track_model]", scifi::slope_state, scifi::line_state, scifi::helix_state) {
  constexpr int N = TestType::dimension;
  scifi::matrix<double, 2, 2> covariance;
  covariance << 0.1, 0.02, 0.02, 0.3;
  const auto x = state<TestType>();
  const point_measurement<TestType> m{{x[TestType::x] + 1.0, x[TestType::y] - 2.0}, covariance};
  const auto seen = scifi::kalman::compare(m, x);
  CHECK(seen.residual[0] == Approx(1.0));
  CHECK(seen.residual[1] == Approx(-2.0));
  CHECK((seen.covariance - covariance).norm() == 0.0);
  const auto position = [](const auto& v) { return scifi::vector<typename std::decay_t<decltype(v)>::Scalar, 2>(v[TestType::x], v[TestType::y]); };
  CHECK((seen.jacobian - scifi::test::derivative<2, N>(position, x)).norm() == 0.0);
}

TEST_CASE("a point is what two crossed fibres say together", "[track_model]") {
  const scifi::vector<double, 5> x = state<scifi::slope_state>();
  const point_measurement<scifi::slope_state> both{{5.0, 6.0}, scifi::vector<double, 2>(0.1, 0.3).asDiagonal()};
  const fibre_measurement<scifi::slope_state> first{5.0, 0.1, 1.0, 0.0, 0.0}, second{6.0, 0.3, 0.0, 1.0, 0.0};
  const auto seen = scifi::kalman::compare(both, x);
  CHECK(seen.residual[0] == scifi::kalman::compare(first, x).residual[0]);
  CHECK(seen.residual[1] == scifi::kalman::compare(second, x).residual[0]);
  CHECK((seen.jacobian.row(0) - first.projection()).norm() == 0.0);
  CHECK((seen.jacobian.row(1) - second.projection()).norm() == 0.0);
}
