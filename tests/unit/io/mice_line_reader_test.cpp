// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/mice_line_reader.hpp>

#include <string>
#include <utility>
#include <vector>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace scifi::test;

TEST_CASE("a line is a statement, a brace is one wherever it stands, and comments are left out", "[io]") {
  const temporary_folder folder;
  const auto path = folder.file("a.dat", "// Caf\xe9\n\nModule A { // open\r\n\tVolume  None\n} }\nPropertyString File ${HOME}/x");
  scifi::mice_line_reader lines(path);
  const std::vector<std::pair<long, std::vector<std::string>>> expected{{3, {"Module", "A"}}, {3, {"{"}}, {4, {"Volume", "None"}},
                                                                        {5, {"}"}},           {5, {"}"}}, {6, {"PropertyString", "File", "${HOME}/x"}}};
  scifi::mice_line_reader::statement s;
  for (const auto& [line, words] : expected) {
    REQUIRE(lines.next(s));
    CHECK(s == words);
    CHECK(lines.line() == line);
  }
  CHECK_FALSE(lines.next(s));
}

TEST_CASE("a file in another encoding is refused with the line", "[io]") {
  const temporary_folder folder;
  const auto message = [&folder](std::string_view content) {
    const auto path = folder.file("a.dat", content);
    return without(path.string(), message_of<scifi::input_error>([&path] {
                     scifi::mice_line_reader lines(path);
                     scifi::mice_line_reader::statement s;
                     while (lines.next(s)) continue;
                   }));
  };
  using namespace std::string_view_literals;
  CHECK(message("Module A\n{\n Volume \xe9\n}\n") == ":3: is not ASCII text: it holds the byte 233");
  CHECK(message("Module \x01\n") == ":1: is not ASCII text: it holds the byte 1");
  CHECK(message("/\0/\0M\0o\0"sv) == ":1: is not ASCII text: it holds a zero byte (UTF-16?)");
  CHECK(message("\xff\xfeM\0"sv) == ":1: is not ASCII text: it holds a zero byte (UTF-16?)");
  CHECK(message("\xef\xbb\xbfModule A {}\n") == "(no error)");
}
