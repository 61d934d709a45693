// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <limits>
#include <set>
#include <string>

#include <scifi/kalman/status.hpp>

namespace kalman = scifi::kalman;
using kalman::reason;

TEST_CASE("a status is good until it has a reason not to be", "[kalman]") {
  STATIC_REQUIRE(kalman::status{}.ok());
  STATIC_REQUIRE_FALSE(kalman::status{kalman::step_kind::update, reason::not_finite}.ok());
  STATIC_REQUIRE(static_cast<bool>(kalman::status{}));
}

TEST_CASE("every step and reason has a name and a description of its own", "[kalman]") {
  std::set<std::string_view> names, words;
  for (int i = 0; i <= static_cast<int>(reason::not_reached); ++i) {
    names.insert(kalman::to_string(static_cast<reason>(i)));
    words.insert(kalman::describe(static_cast<reason>(i)));
  }
  CHECK(names.size() == 8);
  CHECK(words.size() == 8);
  CHECK(names.count("unknown reason") == 0);
  CHECK(words.count("unknown reason") == 0);
  STATIC_REQUIRE(kalman::to_string(kalman::step_kind::smooth) == "smooth");
}

TEST_CASE("numbers that are not finite and negative variances are found", "[kalman]") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const Eigen::Matrix2d one = Eigen::Matrix2d::Identity();
  CHECK(kalman::fault_of<double, 2>({1.0, 2.0}, one) == reason::none);
  CHECK(kalman::fault_of<double, 2>({1.0, nan}, one) == reason::not_finite);
  CHECK(kalman::fault_of<double, 2>({-inf, 1.0}, one) == reason::not_finite);
  CHECK(kalman::fault_of<double, 2>({0.0, 0.0}, inf * one) == reason::not_finite);
  CHECK(kalman::fault_of<double, 2>({0.0, 0.0}, Eigen::Vector2d(1.0, -1e-9).asDiagonal().toDenseMatrix()) == reason::not_positive_definite);
}
