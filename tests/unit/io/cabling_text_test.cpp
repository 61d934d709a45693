// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/cabling_text.hpp>

#include <string>
#include <utility>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"
#include "support/shared_data.hpp"
#include "support/temporary_folder.hpp"

namespace {

using scifi::channel_id;
using scifi::detector;
using scifi::input_error;
using scifi::read_cabling;
using scifi::readout_channel;
using namespace scifi::test;

/// A tracker of one station with a plane of two channels and one of three.
detector small() {
  detector d = scifi::mice::trackers();
  d.trackers.resize(1);
  d.trackers[0].stations.resize(1);
  auto& planes = d.trackers[0].stations[0].planes;
  planes.resize(2);
  planes[0].channels = 2;
  planes[1].channels = 3;
  return d;
}

const std::string good =
    "0 0 5 0 1 0 0 1 1 1\n"
    "0 0 6 0 1 0 1 1 1 2\n";

/// The MICE trackers with the plane of 212 channels as the second of each station.
detector with_short_second_plane() {
  detector d = scifi::mice::trackers();
  for (auto& t : d.trackers)
    for (auto& s : t.stations) {
      std::swap(s.planes[1].channels, s.planes[2].channels);
      std::swap(s.planes[1].central_channel, s.planes[2].central_channel);
    }
  return d;
}

}  // namespace

TEST_CASE("a cabling is read as it is written", "[io]") {
  const temporary_folder folder;
  const std::string text = good + "15 3 127 0 1 1 2 6 6 128\n" + good;  // lines may be repeated, channels may lack a cable
  for (const auto& path : {folder.file("a.txt", text), folder.file("b.txt", gzip(text))}) {
    const auto map = read_cabling(path, small());
    CHECK(map.cables().size() == 3);
    CHECK(map.channel_of({0, 0, 6}) == channel_id{0, 1, 0, 1});
    CHECK(map.cable_of({0, 1, 1, 2}) == readout_channel{15, 3, 127});
    CHECK_FALSE(map.cable_of({0, 1, 1, 0}).has_value());
  }
}

TEST_CASE("a malformed cabling is refused with file, line and column", "[io]") {
  struct row {
    std::string line;
    const char* message;
  };
  const row table[] = {
      {"0 0 7 0 1 1 2 1 1\n", ":3: 9 numbers where 10 belong"},
      {"0 0 7 0 1 1 2 1 1 1 1\n", ":3: 11 numbers where 10 belong"},
      {"0 0 7 0 1 1 two 1 1 1\n", ":3: channel: 'two' is not a whole number"},
      {"16 0 7 0 1 1 2 1 1 1\n", ":3: board: 16 is outside 0 .. 15"},
      {"-1 0 7 0 1 1 2 1 1 1\n", ":3: board: -1 is outside 0 .. 15"},
      {"0 4 7 0 1 1 2 1 1 1\n", ":3: bank: 4 is outside 0 .. 3"},
      {"0 0 128 0 1 1 2 1 1 1\n", ":3: chan_ro: 128 is outside 0 .. 127"},
      {"0 0 7 1 1 1 2 1 1 1\n", ":3: plane: the geometry has no tracker 1 station 1 plane 1"},
      {"0 0 7 0 2 1 2 1 1 1\n", ":3: plane: the geometry has no tracker 0 station 2 plane 1"},
      {"0 0 7 0 1 -1 2 1 1 1\n", ":3: plane: the geometry has no tracker 0 station 1 plane -1"},
      {"0 0 7 0 1 1 3 1 1 1\n", ":3: channel: 3 is outside 0 .. 2 of tracker 0 station 1 plane 1 in the geometry: is it the one of this cabling?"},
      {"0 0 7 0 1 1 -1 1 1 1\n", ":3: channel: -1 is outside 0 .. 2 of tracker 0 station 1 plane 1 in the geometry: is it the one of this cabling?"},
      {"0 0 6 0 1 1 2 1 1 1\n", ":3: chan_ro: board 0 bank 0 channel 6 is connected in line 2 to another channel"},
      {"0 0 7 0 1 0 0 1 1 1\n", ":3: channel: tracker 0 station 1 plane 0 channel 0 has another cable in line 1"},
      {"0 0 7 0 1 1 1 1 1 1\n",
       ":3: channel: tracker 0 station 1 plane 1 is cabled up to channel 1 but has 3 channels in the geometry: is it the one of this cabling?"},
      {"\xFF\xFE", ":3: is not plain ASCII text: byte 0xFF"},
  };
  const temporary_folder folder;
  const detector d = small();
  for (const row& r : table) {
    const auto path = folder.file("a.txt", good + r.line);
    CHECK(without(path.string(), message_of<input_error>([&] { (void)read_cabling(path, d); })) == r.message);
  }
  const auto empty = folder.file("empty.txt", "\n");
  CHECK(without(empty.string(), message_of<input_error>([&] { (void)read_cabling(empty, d); })) == ": connects no channel");
}

TEST_CASE("the published cablings are read with the geometry that goes with them, and refused with another", "[io]") {
  const auto data = shared_data();
  if (!data) return;
  const auto recent = *data / "mice" / "scifi_mapping_2015-09-11.txt";  // third plane of a station has 212 channels
  const auto early = *data / "mice" / "scifi_mapping_7.txt";            // second plane has; three lines are repeated
  const auto map = read_cabling(recent, scifi::mice::trackers());
  CHECK(map.cables().size() == 6400);
  CHECK(map.channel_of({0, 0, 125}) == channel_id{0, 1, 0, 127});  // its first line
  const auto before = read_cabling(early, with_short_second_plane());
  CHECK(before.cables().size() == 6400);
  CHECK(before.channel_of({15, 0, 125}) == channel_id{1, 5, 2, 85});  // its last line

  CHECK(message_of<input_error>([&] { (void)read_cabling(recent, with_short_second_plane()); }).find("is it the one of this cabling?") != std::string::npos);
  CHECK(message_of<input_error>([&] { (void)read_cabling(early, scifi::mice::trackers()); }).find("is it the one of this cabling?") != std::string::npos);
  // Planes that are all long enough hide nothing: the last channels would have no cable.
  detector long_planes = scifi::mice::trackers();
  for (auto& t : long_planes.trackers)
    for (auto& s : t.stations) s.planes[2].channels = 214;
  CHECK(message_of<input_error>([&] { (void)read_cabling(recent, long_planes); }).find("plane 2 is cabled up to channel 211 but has 214") != std::string::npos);
}
