// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/mice_json.hpp>

#include <string>
#include <vector>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"
#include "support/shared_data.hpp"
#include "support/temporary_folder.hpp"

namespace {

using scifi::event;
using scifi::input_error;
using scifi::mice_json_reader;
using namespace scifi::test;

const std::string job = R"({"maus_event_type": "JobHeader"})"
                        "\n";

std::string spill(const std::string& digits) {
  return R"({"maus_event_type": "Spill", "spill_number": 4, "recon_events": [{"sci_fi_event": {"digits": [)" + digits + "]}}]}\n";
}

std::string digit(const char* tracker, const char* station, const char* plane, const char* channel, const char* npe) {
  return std::string("{\"tracker\": ") + tracker + ", \"station\": " + station + ", \"plane\": " + plane + ", \"channel\": " + channel + ", \"npe\": " + npe +
         ", \"time\": 1.0}";
}

}  // namespace

TEST_CASE("every reconstructed event of every spill is an event", "[io]") {
  const temporary_folder folder;
  const std::string text = job + spill(digit("0", "1", "2", "111", "13.5") + "," + digit("1", "5", "0", "7", "2")) + "\n" +
                           R"({"recon_events": [{"sci_fi_event": null}, {"sci_fi_event": {"digits": []}}, {}]})"
                           "\n" +
                           R"({"spill_number": 6, "recon_events": null})"
                           "\n" +
                           spill(digit("0", "1", "2", "111", "13.5"));
  const scifi::detector trackers = scifi::mice::trackers();
  for (const auto& path : {folder.file("a.json", text), folder.file("b.json", gzip(text))}) {
    mice_json_reader reader(path, trackers);
    event e;
    REQUIRE(reader.read(e));
    CHECK(e.number == 0);
    CHECK(reader.spill() == 4);
    REQUIRE(e.digits.size() == 2);
    CHECK(e.digits[0].id == scifi::channel_id{0, 1, 2, 111});
    CHECK(e.digits[0].npe == 13.5);
    CHECK(e.digits[1].id == scifi::channel_id{1, 5, 0, 7});
    for (long number = 1; number <= 3; ++number) {
      REQUIRE(reader.read(e));
      CHECK(e.number == number);
      CHECK(e.digits.empty());
      CHECK(reader.spill() == -1);
    }
    REQUIRE(reader.read(e));
    CHECK(e.number == 4);
    CHECK(e.digits.size() == 1);
    CHECK_FALSE(reader.read(e));
  }
}

TEST_CASE("a malformed document is refused with file, line and field", "[io]") {
  struct row {
    std::string line;
    const char* message;
  };
  const std::string good = digit("0", "1", "2", "111", "13.5");
  const row table[] = {
      {"[1]\n", ":2: the line is not a JSON object"},
      {R"({"recon_events": 5})"
       "\n",
       ":2: recon_events: is not an array"},
      {R"({"recon_events": [{"sci_fi_event": 5}]})"
       "\n",
       ":2: recon_events[0].sci_fi_event: is not an object"},
      {R"({"recon_events": [{"sci_fi_event": {"digits": {}}}]})"
       "\n",
       ":2: recon_events[0].sci_fi_event.digits: is not an array"},
      {spill(R"({"tracker": 0})"), ":2: recon_events[0].sci_fi_event.digits[0].station: is missing"},
      {spill(good + "," + digit("2", "1", "2", "111", "13.5")), ":2: recon_events[0].sci_fi_event.digits[1].tracker: there is no tracker 2"},
      {spill(digit("0", "9", "2", "1", "1")), ":2: recon_events[0].sci_fi_event.digits[0].station: there is no station 9 in tracker 0"},
      {spill(digit("0", "1", "3", "1", "1")), ":2: recon_events[0].sci_fi_event.digits[0].plane: there is no plane 3 in station 1"},
      {spill(digit("0", "1", "2", "212", "1")), ":2: recon_events[0].sci_fi_event.digits[0].channel: 212 is outside 0 .. 211"},
      {spill(digit("0", "1", "2", "1", "-1")), ":2: recon_events[0].sci_fi_event.digits[0].npe: -1.000000 is negative"},
      {spill(digit("0", "1", "2", "1", "null")), ":2: recon_events[0].sci_fi_event.digits[0].npe: 'null' is not a number"},
      {spill(good + "," + good), ":2: recon_events[0].sci_fi_event.digits[1].channel: a second digit of channel 111 in the event, the first is in digit 0"},
  };
  const temporary_folder folder;
  const scifi::detector trackers = scifi::mice::trackers();
  for (const row& r : table) {
    const auto path = folder.file("a.json", job + r.line);
    const std::string message = message_of<input_error>([&] {
      mice_json_reader reader(path, trackers);
      for (event e; reader.read(e);) continue;
    });
    CHECK(without(path.string(), message) == r.message);
  }
  const auto path = folder.file("a.json", job + "{\n  \"recon_events\": []\n}\n");
  mice_json_reader reader(path, trackers);
  event e;
  CHECK(message_of<input_error>([&] { (void)reader.read(e); }).find(path.string() + ":2: is not JSON: ") == 0);
}

TEST_CASE("an empty file is refused", "[io]") {
  const temporary_folder folder;
  mice_json_reader reader(folder.file("a.json", ""), scifi::mice::trackers());
  event e;
  CHECK(message_of<input_error>([&] { (void)reader.read(e); }).find("a.json: the file is empty") != std::string::npos);
}

TEST_CASE("the digits that the experiment's software wrote are all read", "[io]") {
  const auto data = shared_data();
  if (!data) return;
  scifi::detector trackers = scifi::mice::trackers();
  // The geometry of that file has planes of up to 214 channels in an order of its own.
  for (auto& t : trackers.trackers)
    for (auto& s : t.stations)
      for (auto& p : s.planes) p.channels = 214;
  mice_json_reader reader(*data / "mice" / "test_helical_digits.json", trackers);
  std::vector<std::size_t> digits;
  for (event e; reader.read(e);) digits.push_back(e.digits.size());
  // Published beside the file: 34, 31, 33, 31, 31 digits.
  CHECK(digits == std::vector<std::size_t>{34, 31, 33, 31, 31});
}
