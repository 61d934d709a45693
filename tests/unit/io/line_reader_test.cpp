// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/line_reader.hpp>

#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace {

using scifi::input_error;
using scifi::line_reader;
using namespace scifi::test;

std::vector<std::string> lines_of(line_reader& reader) {
  std::vector<std::string> out;
  for (std::string_view line; reader.next(line);) out.emplace_back(line);
  return out;
}

std::vector<std::string> lines_of_text(const std::string& text) {
  const temporary_folder folder;
  line_reader reader(folder.file("a", text));
  return lines_of(reader);
}

}  // namespace

TEST_CASE("lines end with LF or CR LF and the last end may be missing", "[io]") {
  using strings = std::vector<std::string>;
  CHECK(lines_of_text("").empty());
  CHECK(lines_of_text("a\nb\n") == strings{"a", "b"});
  CHECK(lines_of_text("a\r\nb\r\n") == strings{"a", "b"});
  CHECK(lines_of_text("a\nb") == strings{"a", "b"});
  CHECK(lines_of_text("a\r\nb\r") == strings{"a", "b"});
  CHECK(lines_of_text("\n\na\n\n") == strings{"", "", "a", ""});
}

TEST_CASE("a byte order mark is dropped at the start of the file and nowhere else", "[io]") {
  CHECK(lines_of_text("\xEF\xBB\xBF"
                      "a\n\xEF\xBB\xBF"
                      "b\n") == std::vector<std::string>{"a",
                                                         "\xEF\xBB\xBF"
                                                         "b"});
}

TEST_CASE("lines are whole across the borders of blocks, packed or not, and are counted", "[io]") {
  const temporary_folder folder;
  std::string text;
  std::vector<std::string> expected;
  for (int i = 0; i < 60'000; ++i) {
    expected.push_back(std::string(static_cast<std::size_t>(i % 37), 'x') + std::to_string(i));
    text += expected.back() + '\n';
  }
  for (const auto& path : {folder.file("a", text), folder.file("b", gzip(text))}) {
    line_reader reader(path);
    CHECK(lines_of(reader) == expected);
    CHECK(reader.line() == 60'000);
  }
}

TEST_CASE("a line longer than the limit is an error that names the line; one as long as a block is not", "[io]") {
  const temporary_folder folder;
  const std::string longer_than_a_block(600'000, 'x');
  const auto path = folder.file("a", "first\n" + longer_than_a_block + "\nlast\n");
  line_reader patient(path);
  CHECK(lines_of(patient) == std::vector<std::string>{"first", longer_than_a_block, "last"});
  line_reader strict(path, 300'000);
  CHECK(message_of<input_error>([&] { (void)lines_of(strict); }) == path.string() + ":2: the line is longer than 300000 bytes");
}

TEST_CASE("the line where packed data end too early is named", "[io]") {
  const temporary_folder folder;
  std::string text;
  unsigned x = 1;
  for (int i = 0; i < 1000; ++i) text += std::to_string(x = x * 1664525u + 1013904223u) + '\n';
  const std::string packed = gzip(text);
  const auto path = folder.file("a", packed.substr(0, packed.size() / 2));
  line_reader reader(path);
  long complete = 0;
  const std::string message = message_of<input_error>([&] {
    for (std::string_view line; reader.next(line);) ++complete;
  });
  CHECK(complete > 100);
  CHECK(message == path.string() + ':' + std::to_string(complete + 1) + ": the gzip data end too early: the file is truncated");
}
