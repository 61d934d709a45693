// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/digit_writer.hpp>

#include <string>

#include <scifi/geometry/mice.hpp>
#include <scifi/io/digit_reader.hpp>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using scifi::append_digit;
using scifi::channel_id;

TEST_CASE("a digit is a row", "[io]") {
  std::string out;
  append_digit(out, 12345678901, {{1, 5, 2, 211}, 100, 7.69602});
  CHECK(out == "12345678901,1,5,2,211,100,7.696\n");
}

TEST_CASE("digits are read back as they were written, to three decimals", "[io]") {
  std::string text(scifi::digit_columns);
  append_digit(text, 3, {{0, 1, 0, 0}, 46, 2.0005});
  append_digit(text, 3, {{1, 5, 1, 213}, 255, 23.9374});
  append_digit(text, 7, {{1, 5, 1, 213}, 28, 0.0});
  const scifi::test::temporary_folder folder;
  scifi::digit_reader reader(folder.file("a.csv", text), scifi::mice::trackers());
  scifi::event e;
  REQUIRE(reader.read(e));
  CHECK(e.number == 3);
  REQUIRE(e.digits.size() == 2);
  CHECK(e.digits[0].id == channel_id{0, 1, 0, 0});
  CHECK(e.digits[0].npe == Approx(2.0005).margin(0.00051));
  CHECK(e.digits[1].id == channel_id{1, 5, 1, 213});
  CHECK(e.digits[1].npe == Approx(23.937).margin(1e-12));
  REQUIRE(reader.read(e));
  CHECK(e.number == 7);
  CHECK_FALSE(reader.read(e));
}
