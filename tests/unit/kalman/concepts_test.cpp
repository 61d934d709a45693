// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <scifi/kalman/concepts.hpp>
#include <scifi/kalman/gate.hpp>
#include <scifi/kalman/joseph.hpp>

#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

namespace {

struct slopes {};
struct momenta {};
struct in_slopes {
  using state_space = slopes;
};
struct in_momenta {
  using state_space = momenta;
};

}  // namespace

TEST_CASE("the models of the tests satisfy the concepts, for their own dimension only", "[kalman]") {
  STATIC_REQUIRE(kalman::propagator<models::constant_velocity, double, 2, double>);
  STATIC_REQUIRE(kalman::linear_propagator<models::constant_velocity, float, 2, double>);
  STATIC_REQUIRE_FALSE(kalman::general_propagator<models::constant_velocity, double, 2, double>);
  STATIC_REQUIRE_FALSE(kalman::propagator<models::constant_velocity, double, 3, double>);
  STATIC_REQUIRE(kalman::process_noise<models::white_acceleration, double, 2, double>);
  STATIC_REQUIRE(kalman::process_noise<kalman::no_noise, double, 2, double>);
  STATIC_REQUIRE_FALSE(kalman::process_noise<models::position, double, 2, double>);
  STATIC_REQUIRE(kalman::measurement<models::position, double, 2>);
  STATIC_REQUIRE_FALSE(kalman::measurement<models::position, double, 3>);
  STATIC_REQUIRE(kalman::update_policy<kalman::joseph, kalman::estimate<double, 2>, models::position>);
  STATIC_REQUIRE(kalman::gate<kalman::no_gate, double>);
  STATIC_REQUIRE(kalman::gate<kalman::chi2_gate, float>);
  STATIC_REQUIRE_FALSE(kalman::gate<models::position, double>);
}

TEST_CASE("state spaces agree where they are equal or left open", "[kalman]") {
  STATIC_REQUIRE(kalman::detail::same_state_space<in_slopes, in_slopes>);
  STATIC_REQUIRE(kalman::detail::same_state_space<in_slopes, models::position>);
  STATIC_REQUIRE_FALSE(kalman::detail::same_state_space<in_slopes, in_momenta>);
}
