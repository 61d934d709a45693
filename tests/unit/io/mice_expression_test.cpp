// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/mice_expression.hpp>

#include <string>

#include "support/catch.hpp"

using scifi::mice_expression;

TEST_CASE("numbers and arithmetic of MiceModules are evaluated", "[io]") {
  const struct {
    const char* text;
    double value;
  } table[] = {{"5", 5.0},    {"6.", 6.0},    {".1", 0.1},    {"+133.877", 133.877}, {"-0.5709", -0.5709},  {"1e-4", 1e-4},
               {"-+2", -2.0}, {"1+2*3", 7.0}, {"8/2/2", 2.0}, {"2-3-4", -5.0},       {"(1+2)*(3-5)", -6.0}, {"-3300.0+@RepeatNumber*100", -3300.0}};
  for (const auto& row : table) {
    INFO(row.text);
    REQUIRE(mice_expression(row.text).has_value());
    CHECK(*mice_expression(row.text) == row.value);
  }
}

TEST_CASE("what is no number is refused", "[io]") {
  for (const char* text : {"", "x", "1x", "1+", "*2", "(1", "1)", "inf", "nan", "-inf", "1/0", "1e999", "0x10", "1,5", "@Repeat", "--", "1 2"}) {
    INFO(text);
    CHECK_FALSE(mice_expression(text).has_value());
  }
  CHECK_FALSE(mice_expression(std::string(100'000, '(')).has_value());
  CHECK_FALSE(mice_expression(std::string(100'000, '-') + '1').has_value());
}
