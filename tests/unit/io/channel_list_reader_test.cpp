// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/channel_list_reader.hpp>

#include <string>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace scifi;
using namespace scifi::test;

namespace {

const detector trackers = mice::trackers();
const std::string header = "tracker,station,plane,channel\n";

}  // namespace

TEST_CASE("a list of channels is read in its order", "[io]") {
  const temporary_folder folder;
  const std::string text = "note,channel,plane,station,tracker\r\nx,7,2,5,1\r\n\r\n,0,0,1,0\r\nx,7,2,5,1";
  for (const auto& path : {folder.file("a.csv", text), folder.file("b.csv", gzip(text))}) {
    const auto channels = read_channel_list(path, trackers);
    REQUIRE(channels.size() == 3);
    CHECK(channels[0] == channel_id{1, 5, 2, 7});
    CHECK(channels[1] == channel_id{0, 1, 0, 0});
    CHECK(channels[2] == channels[0]);
  }
  CHECK(read_channel_list(folder.file("c.csv", header), trackers).empty());
}

TEST_CASE("a malformed list of channels is refused with file, line and column", "[io]") {
  struct row {
    std::string text;
    const char* message;
  };
  const row table[] = {
      {"", ": the file is empty"},
      {"tracker,station,plane\n", ":1: channel: the header has no column of this name, it reads 'tracker,station,plane'"},
      {header + "0,1,0,1\n0,1,0\n", ":3: 3 fields where the header names 4"},
      {header + "0,1,0,\n", ":2: channel: the field is empty"},
      {header + "0,1,0,1.5\n", ":2: channel: '1.5' is not a whole number"},
      {header + "0,1,0,99999999999\n", ":2: channel: '99999999999' is too large or too small for a number"},
      {header + "0,1,0,-1\n", ":2: channel: -1 is outside 0 .. 213"},
      {header + "0,1,0,214\n", ":2: channel: 214 is outside 0 .. 213"},
      {header + "0,1,3,1\n", ":2: plane: there is no plane 3 in station 1 of tracker 0"},
      {header + "0,6,0,1\n", ":2: plane: there is no plane 0 in station 6 of tracker 0"},
      {header + "2,1,0,1\n", ":2: plane: there is no plane 0 in station 1 of tracker 2"},
      {std::string("\xFF\xFEt\0r\0\n\0", 8), ":1: tracker: the header has no column of this name, it reads '\xFF\xFEt?r?'"},
  };
  const temporary_folder folder;
  for (const row& r : table) {
    const auto path = folder.file("a.csv", r.text);
    CHECK(without(path.string(), message_of<input_error>([&] { (void)read_channel_list(path, trackers); })) == r.message);
  }
}
