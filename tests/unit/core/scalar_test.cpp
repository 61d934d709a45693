// SPDX-License-Identifier: MPL-2.0
#include <scifi/core/scalar.hpp>

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include <limits>
#include <string>

#include "support/catch.hpp"

using dual = Eigen::AutoDiffScalar<Eigen::Vector2d>;

TEST_CASE("floating-point and dual numbers are scalars, strings are not", "[core]") {
  STATIC_REQUIRE(scifi::scalar<double>);
  STATIC_REQUIRE(scifi::scalar<float>);
  STATIC_REQUIRE(scifi::scalar<dual>);
  STATIC_REQUIRE_FALSE(scifi::scalar<std::string>);
}

TEST_CASE("select takes the first where the condition holds", "[core]") {
  CHECK(scifi::select(true, 1.0, 2.0) == 1.0);
  CHECK(scifi::select(false, 1.0, 2.0) == 2.0);
  CHECK(scifi::all_of(true));
  CHECK_FALSE(scifi::any_of(false));
}

TEST_CASE("is_finite refuses what is infinite and what is not a number", "[core]") {
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(scifi::is_finite(0.0));
  CHECK(scifi::is_finite(-std::numeric_limits<double>::max()));
  CHECK(scifi::is_finite(std::numeric_limits<double>::denorm_min()));
  CHECK_FALSE(scifi::is_finite(infinity));
  CHECK_FALSE(scifi::is_finite(-infinity));
  CHECK_FALSE(scifi::is_finite(std::numeric_limits<double>::quiet_NaN()));
  CHECK_FALSE(scifi::is_finite(std::numeric_limits<float>::infinity()));
}

TEST_CASE("larger, smaller, magnitude and square of plain numbers", "[core]") {
  CHECK(scifi::larger_of(1.0, 2.0) == 2.0);
  CHECK(scifi::larger_of(2.0, 1.0) == 2.0);
  CHECK(scifi::smaller_of(1.0, 2.0) == 1.0);
  CHECK(scifi::smaller_of(2.0, 1.0) == 1.0);
  CHECK(scifi::magnitude(-3.0f) == 3.0f);
  CHECK(scifi::magnitude(3.0f) == 3.0f);
  CHECK(scifi::square(-3.0) == 9.0);
}

TEST_CASE("the derivative of a magnitude is the sign, that of a choice belongs to what was chosen", "[core]") {
  const dual x(-2.0, 2, 0), y(5.0, 2, 1);
  CHECK(scifi::magnitude(x).value() == 2.0);
  CHECK(scifi::magnitude(x).derivatives() == Eigen::Vector2d(-1.0, 0.0));
  CHECK(scifi::magnitude(y).derivatives() == Eigen::Vector2d(0.0, 1.0));
  CHECK(scifi::larger_of(x, y).derivatives() == Eigen::Vector2d(0.0, 1.0));
  CHECK(scifi::smaller_of(x, y).derivatives() == Eigen::Vector2d(1.0, 0.0));
  CHECK(scifi::square(x).derivatives() == Eigen::Vector2d(-4.0, 0.0));
}
