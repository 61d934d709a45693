// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <scifi/kalman/gate.hpp>
#include <scifi/kalman/sentences.hpp>
#include <scifi/kalman/square_root.hpp>

#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;
namespace detail = scifi::kalman::detail;

// What is said where they do not fit is held by tests/compile_fail/kalman_*.cpp.
TEST_CASE("parts that fit are let through without a sentence", "[kalman]") {
  STATIC_REQUIRE(detail::prior_fits<kalman::estimate<double, 2>>::value);
  STATIC_REQUIRE(detail::propagator_fits<models::constant_velocity, double, 2, double>::value);
  STATIC_REQUIRE(detail::noise_fits<kalman::no_noise, double, 2, double>::value);
  STATIC_REQUIRE(detail::measurement_fits<models::position, double, 2>::value);
  STATIC_REQUIRE(detail::update_fits<kalman::square_root, kalman::factored_estimate<double, 2>, models::position>::value);
  STATIC_REQUIRE(detail::gate_fits<kalman::chi2_gate, double>::value);
  STATIC_REQUIRE(detail::model_spaces_agree<models::constant_velocity, models::white_acceleration>::value);
  STATIC_REQUIRE(detail::measurement_space_agrees<models::constant_velocity, models::position>::value);
}
