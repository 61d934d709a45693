// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/digit_reader.hpp>

#include <string>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"
#include "support/shared_data.hpp"
#include "support/temporary_folder.hpp"

namespace {

using scifi::digit_reader;
using scifi::event;
using scifi::input_error;
using namespace scifi::test;

const std::string header = "event,tracker,station,plane,channel,adc,npe\n";

}  // namespace

TEST_CASE("digits are gathered into events, from a plain or a packed table", "[io]") {
  const temporary_folder folder;
  const std::string text = header + "3,1,1,0,57,118,9.045\n3,0,5,2,211,1,2\n7,1,1,0,57,90,4.5\n";
  const scifi::detector trackers = scifi::mice::trackers();
  for (const auto& path : {folder.file("a.csv", text), folder.file("b", gzip(text)), folder.file("c.csv", text.substr(0, text.size() - 1))}) {
    digit_reader reader(path, trackers);
    event e;
    e.tracks.resize(4);
    REQUIRE(reader.read(e));
    CHECK(e.number == 3);
    CHECK(e.tracks.empty());
    REQUIRE(e.digits.size() == 2);
    CHECK(e.digits[0].id == scifi::channel_id{1, 1, 0, 57});
    CHECK(e.digits[0].npe == 9.045);
    CHECK(e.digits[1].id == scifi::channel_id{0, 5, 2, 211});
    REQUIRE(reader.read(e));
    CHECK(e.number == 7);
    CHECK(e.digits.size() == 1);
    CHECK_FALSE(reader.read(e));
    CHECK_FALSE(reader.read(e));
    CHECK(e.digits.empty());
  }
}

TEST_CASE("a table with a header alone has no events", "[io]") {
  const temporary_folder folder;
  digit_reader reader(folder.file("a.csv", header + "\n"), scifi::mice::trackers());
  event e;
  CHECK_FALSE(reader.read(e));
}

TEST_CASE("the column order of the file does not matter", "[io]") {
  const temporary_folder folder;
  digit_reader reader(folder.file("a.csv", "\xEF\xBB\xBF\"npe\",\"channel\",\"plane\",\"station\",\"tracker\",\"event\"\r\n5.5,10,1,2,1,99\r\n\r\n"),
                      scifi::mice::trackers());
  event e;
  REQUIRE(reader.read(e));
  CHECK(e.number == 99);
  REQUIRE(e.digits.size() == 1);
  CHECK(e.digits[0].id == scifi::channel_id{1, 2, 1, 10});
  CHECK(e.digits[0].npe == 5.5);
}

TEST_CASE("a malformed table of digits is refused with file, line and column, after the events before it", "[io]") {
  struct row {
    const char* rows;
    int events_before;
    const char* message;
  };
  const row table[] = {
      {"0,0,1,0,1,9,abc\n", 0, ":2: npe: 'abc' is not a number"},
      {"0,0,1,0,1,9,5\n1,0,1,0,1,9,\n", 1, ":3: npe: the field is empty"},
      {"0,0,1,0,1,9,nan\n", 0, ":2: npe: 'nan' is not a finite number"},
      {"0,0,1,0,1,9,-1\n", 0, ":2: npe: -1.000000 is negative"},
      {"0,2,1,0,1,9,5\n", 0, ":2: tracker: there is no tracker 2"},
      {"0,0,6,0,1,9,5\n", 0, ":2: station: there is no station 6 in tracker 0"},
      {"0,0,1,3,1,9,5\n", 0, ":2: plane: there is no plane 3 in station 1"},
      {"0,0,1,0,214,9,5\n", 0, ":2: channel: 214 is outside 0 .. 213"},
      {"0,0,1,0,1.5,9,5\n", 0, ":2: channel: '1.5' is not a whole number"},
      {"0,0,1,0,1,9,5\n0,0,1,1,1,9,5\n0,0,1,0,1,9,6\n", 0, ":4: channel: a second digit of channel 1 in the event, the first is in line 2"},
      {"0,0,1,0,1,9,5\n2,0,1,0,1,9,5\n1,0,1,0,1,9,6\n", 1, ":4: event: 1 comes after 2: the rows of an event must stand together and event numbers must grow"},
      {"0,0,1,0,1,9,5\n1,0,1,0,1,9,5\n0,0,1,0,2,9,6\n", 1, ":4: event: 0 comes after 1: the rows of an event must stand together and event numbers must grow"},
      {"x,0,1,0,1,9,5\n", 0, ":2: event: 'x' is not a whole number"},
      {"0,0,1,0,1,5\n", 0, ":2: 6 fields where the header names 7"},
  };
  const temporary_folder folder;
  const scifi::detector trackers = scifi::mice::trackers();
  for (const row& r : table) {
    const auto path = folder.file("a.csv", header + r.rows);
    int events = 0;
    const std::string message = message_of<input_error>([&] {
      digit_reader reader(path, trackers);
      for (event e; reader.read(e);) ++events;
    });
    CHECK(without(path.string(), message) == r.message);
    CHECK(events == r.events_before);
  }
}

TEST_CASE("the simulated digits of both trackers are read to the last one", "[io]") {
  const auto data = shared_data();
  if (!data) return;
  // Numbers of rows and of distinct events counted with zcat, tail, cut, uniq and wc.
  digit_reader reader(*data / "g4" / "tkd_helical_digits.csv.gz", scifi::mice::trackers());
  long events = 0;
  long digits = 0;
  for (event e; reader.read(e);) {
    ++events;
    digits += static_cast<long>(e.digits.size());
  }
  CHECK(events == 6000);
  CHECK(digits == 128393);
}
