// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/raw_reader.hpp>

#include <string>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace {

using scifi::input_error;
using scifi::raw_event;
using scifi::raw_reader;
using scifi::readout_channel;
using namespace scifi::test;

const std::string header = "event,board,bank,channel,adc\n";

}  // namespace

TEST_CASE("raw counts are read event by event", "[io]") {
  const temporary_folder folder;
  const std::string text = "adc,note,channel,bank,board,event\r\n100,x,125,0,0,4\r\n255,,127,3,15,4\r\n\r\n0,y,125,0,0,9";
  for (const auto& path : {folder.file("a.csv", text), folder.file("b.csv", gzip(text))}) {
    raw_reader reader(path);
    raw_event e;
    REQUIRE(reader.read(e));
    CHECK(e.number == 4);
    REQUIRE(e.counts.size() == 2);
    CHECK(e.counts[0].from == readout_channel{0, 0, 125});
    CHECK(e.counts[0].adc == 100);
    CHECK(e.counts[1].from == readout_channel{15, 3, 127});
    CHECK(e.counts[1].adc == 255);
    REQUIRE(reader.read(e));
    CHECK(e.number == 9);
    REQUIRE(e.counts.size() == 1);
    CHECK(e.counts[0].adc == 0);
    CHECK_FALSE(reader.read(e));
  }
  raw_event e;
  CHECK_FALSE(raw_reader(folder.file("c.csv", header)).read(e));
}

TEST_CASE("a malformed table of raw counts is refused with file, line and column, after the events before it", "[io]") {
  struct row {
    std::string text;
    int events_before;
    const char* message;
  };
  const row table[] = {
      {"", 0, ": the file is empty"},
      {"event,board,bank,channel\n", 0, ":1: adc: the header has no column of this name, it reads 'event,board,bank,channel'"},
      {header + "0,0,0,1,100\n0,0,0,2\n", 0, ":3: 4 fields where the header names 5"},
      {header + "0,0,0,1,100\n1,0,0,1,1e2\n", 1, ":3: adc: '1e2' is not a whole number"},
      {header + "0,16,0,1,100\n", 0, ":2: board: 16 is outside 0 .. 15"},
      {header + "0,-1,0,1,100\n", 0, ":2: board: -1 is outside 0 .. 15"},
      {header + "0,0,4,1,100\n", 0, ":2: bank: 4 is outside 0 .. 3"},
      {header + "0,0,0,128,100\n", 0, ":2: channel: 128 is outside 0 .. 127"},
      {header + "0,0,0,4294967296,100\n", 0, ":2: channel: '4294967296' is too large or too small for a number"},
      {header + "0,0,0,1,256\n", 0, ":2: adc: 256 is outside 0 .. 255"},
      {header + "0,0,0,1,-1\n", 0, ":2: adc: -1 is outside 0 .. 255"},
      {header + "0,0,0,1,\n", 0, ":2: adc: the field is empty"},
      {header + "0,0,0,1,9\n0,0,0,2,9\n0,0,0,1,9\n", 0, ":4: channel: a second count of this channel in the event, the first is in line 2"},
      {header + "0,0,0,1,9\n2,0,0,1,9\n1,0,0,1,9\n", 1, ":4: event: 1 comes after 2: the rows of an event must stand together and event numbers must grow"},
      {header + "x,0,0,1,9\n", 0, ":2: event: 'x' is not a whole number"},
      {std::string("\0e\0v\n", 5), 0, ":1: event: the header has no column of this name, it reads '?e?v'"},
  };
  const temporary_folder folder;
  for (const row& r : table) {
    const auto path = folder.file("a.csv", r.text);
    int events = 0;
    const std::string message = message_of<input_error>([&] {
      raw_reader reader(path);
      for (raw_event e; reader.read(e);) ++events;
    });
    CHECK(without(path.string(), message) == r.message);
    CHECK(events == r.events_before);
  }
}

TEST_CASE("the largest count is that of the ADC", "[io]") {
  const temporary_folder folder;
  scifi::readout_layout layout;
  layout.largest_count = 4095;
  const auto path = folder.file("a.csv", header + "0,0,0,1,4095\n");
  raw_reader reader(path, layout);
  raw_event e;
  REQUIRE(reader.read(e));
  CHECK(e.counts[0].adc == 4095);
}
