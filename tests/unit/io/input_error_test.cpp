// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/input_error.hpp>

#include <string>

#include "support/catch.hpp"

using scifi::in_quotes;
using scifi::input_error;

TEST_CASE("an input error names file, line, field and reason in one sentence", "[io]") {
  const input_error e("digits.csv", 17, "npe", "'abc' is not a number");
  CHECK(std::string(e.what()) == "digits.csv:17: npe: 'abc' is not a number");
  CHECK(e.file() == "digits.csv");
  CHECK(e.line() == 17);
  CHECK(e.field() == "npe");
  CHECK(e.reason() == "'abc' is not a number");
}

TEST_CASE("an input error leaves out the parts that do not apply", "[io]") {
  CHECK(std::string(input_error("a", 0, "", "is empty").what()) == "a: is empty");
  CHECK(std::string(input_error("a", 3, "", "is short").what()) == "a:3: is short");
  CHECK(std::string(input_error("a", 0, "planes[1]", "is missing").what()) == "a: planes[1]: is missing");
}

TEST_CASE("text from a file is quoted safely and briefly in messages", "[io]") {
  CHECK(in_quotes("abc") == "'abc'");
  CHECK(in_quotes("a\tb\x1b[31m") == "'a?b?[31m'");
  CHECK(in_quotes(std::string(40, 'x')) == "'" + std::string(40, 'x') + "'");
  CHECK(in_quotes(std::string(41, 'x')) == "'" + std::string(40, 'x') + "...'");
}
