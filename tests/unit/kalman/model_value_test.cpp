// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <type_traits>

#include <scifi/kalman/model_value.hpp>

namespace kalman = scifi::kalman;

TEST_CASE("propagated and projected deduce their sizes", "[kalman]") {
  const kalman::propagated moved{Eigen::Vector3d(1.0, 2.0, 3.0), Eigen::Matrix3d::Identity()};
  STATIC_REQUIRE(std::is_same_v<std::remove_const_t<decltype(moved)>, kalman::propagated<double, 3>>);
  const kalman::projected seen{Eigen::Vector2d(1.0, 2.0), Eigen::Matrix<double, 2, 5>::Ones()};
  STATIC_REQUIRE(std::is_same_v<std::remove_const_t<decltype(seen)>, kalman::projected<double, 2, 5>>);
  CHECK(moved.state(2) == 3.0);
  CHECK(seen.jacobian(1, 4) == 1.0);
}
