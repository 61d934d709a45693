// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/bad_channels_text.hpp>

#include <string>

#include "support/catch.hpp"
#include "support/shared_data.hpp"
#include "support/temporary_folder.hpp"

using scifi::input_error;
using scifi::read_bad_channels;
using namespace scifi::test;

TEST_CASE("bad channels are read by the bank counted through all boards", "[io]") {
  const temporary_folder folder;
  const std::string text = "0 64\r\n63 120\n7 5\n0 64\n";
  for (const auto& path : {folder.file("a.txt", text), folder.file("b.txt", gzip(text))}) {
    const auto bad = read_bad_channels(path);
    CHECK(bad.size() == 3);
    CHECK(bad.contains({0, 0, 64}));
    CHECK(bad.contains({15, 3, 120}));
    CHECK(bad.contains({1, 3, 5}));
  }
  CHECK(read_bad_channels(folder.file("c.txt", "")).size() == 0);
}

TEST_CASE("a malformed list of bad channels is refused with file, line and column", "[io]") {
  struct row {
    const char* text;
    const char* message;
  };
  const row table[] = {
      {"0 64\n1\n", ":2: 1 number where 2 belong"},
      {"0 64 1\n", ":1: 3 numbers where 2 belong"},
      {"64 0\n", ":1: bank: 64 is outside 0 .. 63"},
      {"-1 0\n", ":1: bank: -1 is outside 0 .. 63"},
      {"0 128\n", ":1: channel: 128 is outside 0 .. 127"},
      {"0 -1\n", ":1: channel: -1 is outside 0 .. 127"},
      {"0,64\n", ":1: bank: '0,64' is not a whole number"},
      {"0 6\xC3\xA9\n", ":1: is not plain ASCII text: byte 0xC3"},
      {"99999999999 0\n", ":1: bank: '99999999999' is too large or too small for a number"},
  };
  const temporary_folder folder;
  for (const row& r : table) {
    const auto path = folder.file("a.txt", r.text);
    CHECK(without(path.string(), message_of<input_error>([&] { (void)read_bad_channels(path); })) == r.message);
  }
}

TEST_CASE("the published bad channels are read", "[io]") {
  const auto data = shared_data();
  if (!data) return;
  const auto bad = read_bad_channels(*data / "mice" / "scifi_bad_channels.txt");
  CHECK(bad.size() == 141);  // lines of the file
  CHECK(bad.contains({0, 0, 64}));     // its first
  CHECK(bad.contains({15, 3, 120}));   // its last
}
