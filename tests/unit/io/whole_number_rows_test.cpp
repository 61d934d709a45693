// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/whole_number_rows.hpp>

#include <string>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using scifi::input_error;
using scifi::whole_number_rows;
using namespace scifi::test;

TEST_CASE("numbers between blanks are read line by line", "[io]") {
  const temporary_folder folder;
  const std::string text = "\xEF\xBB\xBF 1 2\r\n\n \t\r\n-3\t  2147483647";
  for (const auto& path : {folder.file("a.txt", text), folder.file("b.txt", gzip(text))}) {
    whole_number_rows rows(path, {"a", "b"});
    REQUIRE(rows.next());
    CHECK(rows[0] == 1);
    CHECK(rows[1] == 2);
    CHECK(rows.line() == 1);
    REQUIRE(rows.next());
    CHECK(rows[0] == -3);
    CHECK(rows[1] == 2147483647);
    CHECK(rows.line() == 4);
    CHECK(rows.within(0, -3, -3) == -3);
    CHECK_FALSE(rows.next());
  }
  CHECK_FALSE(whole_number_rows(folder.file("c.txt", ""), {"a"}).next());
}

TEST_CASE("a line that is not so many numbers is refused with line and column", "[io]") {
  struct row {
    std::string text;
    const char* message;
  };
  const row table[] = {
      {"1 2 3\n1 2\n", ":2: 2 numbers where 3 belong"},
      {"1\n", ":1: 1 number where 3 belong"},
      {"1 2 3 4\n", ":1: 4 numbers where 3 belong"},
      {"1 x 3\n", ":1: b: 'x' is not a whole number"},
      {"1 2,3 3\n", ":1: b: '2,3' is not a whole number"},
      {"1 2 3.5\n", ":1: c: '3.5' is not a whole number"},
      {"1 2 0x3\n", ":1: c: '0x3' is not a whole number"},
      {"+1 2 3\n", ":1: a: '+1' is not a whole number"},
      {"1 2 2147483648\n", ":1: c: '2147483648' is too large or too small for a number"},
      {"1 2 3\n# note\n", ":2: a: '#' is not a whole number"},
      {"1 2 11\n", ":1: c: 11 is outside 0 .. 10"},
      {"1 2 -1\n", ":1: c: -1 is outside 0 .. 10"},
      // UTF-16 with and without its mark, a no-break space, a binary file
      {std::string("\xFF\xFE\x31\x00\x20\x00", 6), ":1: is not plain ASCII text: byte 0xFF"},
      {std::string("\x31\x00\x20\x00", 4), ":1: is not plain ASCII text: byte 0x00"},
      {"1 2\xC2\xA0 3\n", ":1: is not plain ASCII text: byte 0xC2"},
      {"\x7f" "ELF\n", ":1: is not plain ASCII text: byte 0x7F"},
  };
  const temporary_folder folder;
  for (const row& r : table) {
    const auto path = folder.file("a.txt", r.text);
    const std::string message = message_of<input_error>([&] {
      whole_number_rows rows(path, {"a", "b", "c"});
      while (rows.next()) (void)rows.within(2, 0, 10);
    });
    CHECK(without(path.string(), message) == r.message);
  }
  CHECK(message_of<input_error>([&] { whole_number_rows rows(folder / "none.txt", {"a"}); }).find("none.txt: cannot be opened") != std::string::npos);
}
