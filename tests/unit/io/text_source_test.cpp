// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/text_source.hpp>

#include <algorithm>
#include <string>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace {

using scifi::input_error;
using scifi::text_source;
using namespace scifi::test;

std::string read_all(text_source& source, std::size_t at_once) {
  std::string out, block(at_once, '\0');
  while (const std::size_t n = source.read(block.data(), block.size())) out.append(block, 0, n);
  return out;
}

/// A text of many lines that does not pack to nothing.
std::string long_text(std::size_t bytes) {
  std::string out;
  unsigned x = 12345;
  while (out.size() < bytes) {
    x = x * 1103515245u + 12345u;
    out += std::to_string(x >> 8) + '\n';
  }
  return out;
}

}  // namespace

TEST_CASE("a plain file is read as it is, in blocks of any size", "[io]") {
  const temporary_folder folder;
  const std::string text = long_text(1'000'000);
  const auto path = folder.file("a.txt", text);
  for (const std::size_t at_once : {std::size_t{1000}, std::size_t{1} << 18, std::size_t{3'000'000}}) {
    text_source source(path);
    CHECK_FALSE(source.compressed());
    CHECK(read_all(source, at_once) == text);
    CHECK(source.consumed() == text.size());
    CHECK(source.size() == text.size());
  }
}

TEST_CASE("a gzip file is known by its content, not by its name, and several members are one text", "[io]") {
  const temporary_folder folder;
  const std::string text = long_text(1'000'000);
  const std::string packed = gzip(text.substr(0, 700'001)) + gzip("") + gzip(text.substr(700'001));
  const auto path = folder.file("a.csv", packed);
  for (const std::size_t at_once : {std::size_t{1000}, std::size_t{1} << 18}) {
    text_source source(path);
    CHECK(source.compressed());
    CHECK(read_all(source, at_once) == text);
    CHECK(source.consumed() == packed.size());
  }
}

TEST_CASE("a name that ends in gz does not make a plain file a packed one", "[io]") {
  const temporary_folder folder;
  text_source source(folder.file("a.gz", "event\n"));
  CHECK(read_all(source, 100) == "event\n");
}

TEST_CASE("a gzip file cut anywhere is an error after what could be read", "[io]") {
  const temporary_folder folder;
  const std::string text = long_text(20'000);
  const std::string packed = gzip(text);
  for (const std::size_t length : {std::size_t{2}, std::size_t{5}, std::size_t{11}, packed.size() / 2, packed.size() - 8, packed.size() - 1}) {
    text_source source(folder.file("a.gz", packed.substr(0, length)));
    const std::string message = message_of<input_error>([&] { (void)read_all(source, 100'000); });
    CHECK(message.find("a.gz: the gzip data end too early: the file is truncated") != std::string::npos);
  }
}

TEST_CASE("damaged gzip data are an error", "[io]") {
  const temporary_folder folder;
  std::string packed = gzip(long_text(20'000));
  SECTION("in the middle") { std::fill_n(packed.begin() + static_cast<long>(packed.size() / 2), 50, '\xff'); }
  SECTION("in the check sum") { packed[packed.size() - 6] = static_cast<char>(packed[packed.size() - 6] ^ 1); }
  SECTION("behind the end") { packed += "rubbish"; }
  text_source source(folder.file("a.gz", packed));
  CHECK(message_of<input_error>([&] { (void)read_all(source, 1000); }).find("a.gz: the gzip data are damaged: ") != std::string::npos);
}

TEST_CASE("a file that is not there and a folder are errors that say so", "[io]") {
  const temporary_folder folder;
  CHECK(message_of<input_error>([&] { text_source source(folder / "none"); }).find("none: cannot be opened: No such file") != std::string::npos);
  CHECK(message_of<input_error>([&] { text_source source(folder.path()); }).find("cannot be read: Is a directory") != std::string::npos);
}

TEST_CASE("an empty file gives no bytes", "[io]") {
  const temporary_folder folder;
  text_source source(folder.file("a", ""));
  CHECK(read_all(source, 10).empty());
  CHECK_FALSE(source.size().has_value());
}

TEST_CASE("a file is read whole, unpacked if need be, unless it is far too long", "[io]") {
  const temporary_folder folder;
  const std::string text = std::string(200'000, 'x') + '\0' + "end";
  CHECK(scifi::text_of_file(folder.file("plain", text)) == text);
  CHECK(scifi::text_of_file(folder.file("packed", gzip(text))) == text);
  CHECK(scifi::text_of_file(folder.file("empty", "")).empty());
  CHECK(message_of<input_error>([&] { static_cast<void>(scifi::text_of_file(folder / "plain", 1000)); }) ==
        (folder / "plain").string() + ": is longer than 1000 bytes");
  CHECK_THROWS_AS(scifi::text_of_file(folder / "none"), input_error);
}
