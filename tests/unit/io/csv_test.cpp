// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/csv.hpp>

#include <limits>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace {

using scifi::csv_reader;
using scifi::input_error;
using namespace scifi::test;

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string_view> fields;
  scifi::split_fields(line, fields);
  return {fields.begin(), fields.end()};
}

}  // namespace

TEST_CASE("a line is split at its commas", "[io]") {
  using strings = std::vector<std::string>;
  CHECK(split("a,b,c") == strings{"a", "b", "c"});
  CHECK(split("") == strings{""});
  CHECK(split(",") == strings{"", ""});
  CHECK(split(" a ,\tb b, ") == strings{"a", "b b", ""});
  CHECK(split(R"("a","b,c" , "d""e")") == strings{"a", "b,c", R"(d""e)"});
  CHECK(split(R"("a,b)") == strings{R"("a,b)"});
  CHECK(split(R"( a,b", c,d",e)") == strings{"a", R"(b", c,d")", "e"});
}

TEST_CASE("columns are found by name in any order, the others are ignored", "[io]") {
  const temporary_folder folder;
  csv_reader rows(folder.file("a.csv", "npe, \"event\" ,note\r\n1.5,7,x\r\n\r\n-2e3,-8,\"y,z\"\r\n\r\n  \r\n"), {"event", "npe"});
  REQUIRE(rows.next_row());
  CHECK(rows.whole_number<long>(0) == 7);
  CHECK(rows.number(1) == 1.5);
  CHECK(rows.line() == 2);
  REQUIRE(rows.next_row());
  CHECK(rows.whole_number<long>(0) == -8);
  CHECK(rows.number(1) == -2000.0);
  CHECK(rows.line() == 4);
  CHECK_FALSE(rows.next_row());
}

TEST_CASE("a wrong table is refused with line and column", "[io]") {
  struct row {
    const char* text;
    const char* message;
  };
  const row table[] = {
      {"", ": the file is empty"},
      {"\n", ":1: event: the header has no column of this name, it reads ''"},
      {"event,adc\n", ":1: npe: the header has no column of this name, it reads 'event,adc'"},
      {"0,1,2.5\n", ":1: event: the header has no column of this name, it reads '0,1,2.5'"},
      {"event,npe,event\n", ":1: event: the header names this column twice"},
      {"event,npe\n1,2\n1\n", ":3: 1 field where the header names 2"},
      {"event,npe\n1,2,3\n", ":2: 3 fields where the header names 2"},
      {"event,npe\n1,abc\n", ":2: npe: 'abc' is not a number"},
      {"event,npe\n1,1.5x\n", ":2: npe: '1.5x' is not a number"},
      {"event,npe\n1,\n", ":2: npe: the field is empty"},
      {"event,npe\n1,nan\n", ":2: npe: 'nan' is not a finite number"},
      {"event,npe\n1,-inf\n", ":2: npe: '-inf' is not a finite number"},
      {"event,npe\n1,1e999\n", ":2: npe: '1e999' is too large or too small for a number"},
      {"event,npe\n1.5,1\n", ":2: event: '1.5' is not a whole number"},
      {"event,npe\nx,1\n", ":2: event: 'x' is not a whole number"},
      {"event,npe\n99999999999999999999,1\n", ":2: event: '99999999999999999999' is too large or too small for a number"},
  };
  const temporary_folder folder;
  for (const row& r : table) {
    const auto path = folder.file("a.csv", r.text);
    const std::string message = message_of<input_error>([&] {
      csv_reader rows(path, {"event", "npe"});
      while (rows.next_row()) {
        (void)rows.whole_number<long>(0);
        (void)rows.number(1);
      }
    });
    CHECK(without(path.string(), message) == r.message);
  }
}

TEST_CASE("a whole number that does not fit its type is refused", "[io]") {
  const temporary_folder folder;
  csv_reader rows(folder.file("a.csv", "channel\n2147483647\n2147483648\n"), {"channel"});
  REQUIRE(rows.next_row());
  CHECK(rows.whole_number<int>(0) == std::numeric_limits<int>::max());
  REQUIRE(rows.next_row());
  CHECK_THROWS_AS(rows.whole_number<int>(0), input_error);
}

TEST_CASE("a number that may be missing, and a field as it stands", "[io]") {
  const temporary_folder folder;
  csv_reader rows(folder.file("a.csv", "x,name\nnan,helix\n1.5, line \ninf,\n"), {"x", "name"});
  REQUIRE(rows.next_row());
  CHECK(rows.number_or_nan(0) != rows.number_or_nan(0));
  CHECK(rows.text(1) == "helix");
  REQUIRE(rows.next_row());
  CHECK(rows.number_or_nan(0) == 1.5);
  CHECK(rows.text(1) == "line");
  REQUIRE(rows.next_row());
  CHECK(message_of<input_error>([&] { static_cast<void>(rows.number_or_nan(0)); }).ends_with("a.csv:4: x: 'inf' is not a finite number"));
}
