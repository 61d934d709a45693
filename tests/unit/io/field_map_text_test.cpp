// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/field_map_text.hpp>

#include <string>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace scifi;
using namespace scifi::test;
using scifi::detail::field_map_text;

TEST_CASE("rows are read in the units and the order that the file declares", "[io]") {
  const temporary_folder folder;
  const std::string text =
      "# of a survey\r\nscifi field map\n\ngrid cylindrical\nlength cm   # as measured\nfield kG\nmirror z br odd bz even\ncolumns bz br z r\n30, 1.5, 2, 0.5\n\n-1 0\t0 7\n";
  for (const auto& path : {folder.file("a.txt", text), folder.file("a.txt.gz", gzip(text))}) {
    const field_map_text got(path);
    CHECK(got.cylindrical);
    REQUIRE(got.rows.size() == 2);
    CHECK(got.rows[0].line == 9);
    CHECK(got.rows[1].line == 11);
    CHECK(got.rows[0].value[0] == Approx(5.0));
    CHECK(got.rows[0].value[1] == Approx(20.0));
    CHECK(got.rows[0].value[2] == Approx(0.15 * units::tesla));
    CHECK(got.rows[0].value[3] == Approx(3.0 * units::tesla));
    CHECK(got.rows[1].value[0] == Approx(70.0));
    REQUIRE(got.mirrors.size() == 1);
    CHECK(got.mirrors[0].axis == 1);
    CHECK(got.mirrors[0].sign[0] == -1);
    CHECK(got.mirrors[0].sign[1] == 1);
  }
}

TEST_CASE("units of length and field", "[io]") {
  const temporary_folder folder;
  const auto first = [&folder](const std::string& length, const std::string& field) {
    return field_map_text(folder.file("a", "scifi field map\ngrid cartesian\nlength " + length + "\nfield " + field + "\ncolumns x y z bx by bz\n1 0 0 0 0 1\n")).rows[0].value;
  };
  CHECK(first("mm", "T")[0] == 1.0);
  CHECK(first("cm", "T")[0] == 10.0);
  CHECK(first("m", "T")[0] == 1000.0);
  CHECK(first("mm", "T")[5] == units::tesla);
  CHECK(first("mm", "mT")[5] == Approx(1e-3 * units::tesla));
  CHECK(first("mm", "kG")[5] == Approx(0.1 * units::tesla));
  CHECK(first("mm", "G")[5] == Approx(1e-4 * units::tesla));
}
