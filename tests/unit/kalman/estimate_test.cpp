// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <cmath>
#include <type_traits>

#include <scifi/kalman/estimate.hpp>

namespace kalman = scifi::kalman;

TEST_CASE("scalar and dimension of an estimate are deduced from fixed-size Eigen expressions", "[kalman]") {
  const kalman::estimate e{Eigen::Vector3f::Zero(), 4.0F * Eigen::Matrix3f::Identity()};
  STATIC_REQUIRE(std::is_same_v<std::remove_const_t<decltype(e)>, kalman::estimate<float, 3>>);
  CHECK(e.mean(2) == 0.0F);
  CHECK(e.covariance(1, 1) == 4.0F);
}

TEST_CASE("sigma is the root of a variance and NaN where the variance is negative", "[kalman]") {
  enum class component { x, y, z };
  const kalman::estimate e{Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(9.0, -9.0, 0.0).asDiagonal().toDenseMatrix()};
  CHECK(kalman::sigma(e, component::x) == 3.0);
  CHECK(std::isnan(kalman::sigma(e, component::y)));
  CHECK(kalman::sigma(e, component::z) == 0.0);
}

TEST_CASE("uncorrelated components are given by their standard deviations", "[kalman]") {
  const auto e = kalman::uncorrelated(Eigen::Vector2d(1.0, 2.0), Eigen::Vector2d(3.0, 4.0));
  CHECK(e.covariance == Eigen::Vector2d(9.0, 16.0).asDiagonal().toDenseMatrix());
  const auto one = kalman::uncorrelated(20.0, 2.0);
  CHECK(one.mean(0) == 20.0);
  CHECK(one.covariance(0, 0) == 4.0);
  const auto whole = kalman::uncorrelated(20, 2), mixed = kalman::uncorrelated(20, 2.0), narrow = kalman::uncorrelated(20.0, 2.0F);
  STATIC_REQUIRE(std::is_same_v<decltype(whole), const kalman::estimate<double, 1>>);
  for (const auto& e1 : {whole, mixed, narrow}) CHECK((e1.mean == one.mean && e1.covariance == one.covariance));
}
