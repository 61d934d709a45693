// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/fixed_point.hpp>

#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <string>

#include "support/catch.hpp"

namespace {

std::string fixed(double value, int decimals) {
  std::string out;
  scifi::append_fixed(out, value, decimals);
  return out;
}

}  // namespace

TEST_CASE("numbers are written with a fixed number of decimals", "[io]") {
  CHECK(fixed(0.0, 3) == "0.000");
  CHECK(fixed(1.0, 0) == "1");
  CHECK(fixed(-1.25, 2) == "-1.25");
  CHECK(fixed(0.05, 1) == "0.1");
  CHECK(fixed(99.999, 2) == "100.00");
  CHECK(fixed(123456789.125, 3) == "123456789.125");
  CHECK(fixed(1e-9, 5) == "0.00000");
  CHECK(fixed(-1e-9, 5) == "0.00000");
  CHECK(fixed(-0.0, 1) == "0.0");
}

TEST_CASE("numbers that are none and numbers too large for the fast way are written too", "[io]") {
  CHECK(fixed(std::numeric_limits<double>::quiet_NaN(), 3) == "nan");
  CHECK(fixed(-std::numeric_limits<double>::quiet_NaN(), 3) == "nan");
  CHECK(fixed(std::numeric_limits<double>::infinity(), 3) == "inf");
  CHECK(fixed(-std::numeric_limits<double>::infinity(), 3) == "-inf");
  CHECK(fixed(-1e18, 2) == "-1000000000000000000.00");
  CHECK(fixed(1e300, 1).size() == 303);
}

TEST_CASE("what is written is within half a unit of the last decimal of the number", "[io]") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-6.0, 6.0);
  std::uniform_real_distribution<double> sign(-1.0, 1.0);
  for (int i = 0; i < 20'000; ++i) {
    const double value = std::copysign(std::pow(10.0, exponent(random)), sign(random));
    const int decimals = i % 8;
    const double back = std::stod(fixed(value, decimals));
    // half a unit, and the rounding of the scaled number and of reading it back
    const double tolerance = 0.5 * std::pow(10.0, -decimals) + 4.0 * std::numeric_limits<double>::epsilon() * std::abs(value);
    REQUIRE(std::abs(back - value) <= tolerance);
    char reference[64];
    std::snprintf(reference, sizeof reference, "%.*f", decimals, value);
    REQUIRE(std::abs(std::stod(reference) - back) <= 2.0 * tolerance);
  }
}

TEST_CASE("whole numbers are appended", "[io]") {
  std::string out = "a";
  scifi::append_integer(out, std::numeric_limits<long>::min());
  scifi::append_integer(out, 42);
  CHECK(out == "a-922337203685477580842");
}
