// SPDX-License-Identifier: MPL-2.0
#include <scifi/conditions/recorded_time.hpp>

#include <chrono>
#include <ctime>
#include <random>
#include <stdexcept>
#include <string>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

namespace {

using scifi::recorded_time;
using scifi::recorded_time_from;
using scifi::test::message_of;

long long seconds_of(const std::string& text) { return recorded_time_from(text).time_since_epoch().count(); }

}  // namespace

TEST_CASE("a date names the second that other clocks give it", "[conditions]") {
  // Values from `date -u -d ... +%s`.
  CHECK(seconds_of("1970-01-01") == 0);
  CHECK(seconds_of("2015-11-05T14:30:00Z") == 1446733800);
  CHECK(seconds_of("2015-11-05T14:30:00") == 1446733800);
  CHECK(seconds_of("2015-11-05T14:30Z") == 1446733800);
  CHECK(seconds_of("2015-11-05 14:30:07") == 1446733807);
  CHECK(seconds_of("2016-02-29T23:59:59Z") == 1456790399);
  CHECK(seconds_of("2000-02-29") == 951782400);
  CHECK(seconds_of("1969-12-31T23:59:59Z") == -1);
}

TEST_CASE("a date alone is the first second of its day or the last", "[conditions]") {
  const auto last = recorded_time_from("2015-11-05", scifi::date_alone::last_second);
  CHECK(scifi::to_text(last) == "2015-11-05T23:59:59Z");
  CHECK(scifi::to_text(recorded_time_from("2015-11-05")) == "2015-11-05T00:00:00Z");
  CHECK(scifi::to_text(recorded_time_from("2015-11-05T10:00", scifi::date_alone::last_second)) == "2015-11-05T10:00:00Z");
}

TEST_CASE("what is written is read again, and agrees with the C library", "[conditions]") {
  std::mt19937_64 random(11);
  std::uniform_int_distribution<long long> seconds(-2'000'000'000LL, 20'000'000'000LL);
  for (int i = 0; i < 2000; ++i) {
    const recorded_time t{std::chrono::seconds(seconds(random))};
    const std::string text = scifi::to_text(t);
    CHECK(recorded_time_from(text) == t);
    const std::time_t c = static_cast<std::time_t>(t.time_since_epoch().count());
    std::tm parts{};
    char expected[64];
    REQUIRE(gmtime_r(&c, &parts) != nullptr);
    std::strftime(expected, sizeof expected, "%Y-%m-%dT%H:%M:%SZ", &parts);
    CHECK(text == expected);
  }
}

TEST_CASE("a text that is no date is refused with the reason", "[conditions]") {
  const std::string form = "it should read like 2015-11-05 or 2015-11-05T14:30:00Z";
  const auto refused = [](const char* text) { return message_of<std::invalid_argument>([&] { static_cast<void>(recorded_time_from(text)); }); };
  CHECK(refused("") == "'' is not a date: the year is not 4 digits");
  CHECK(refused("yesterday") == "'yesterday' is not a date: the year is not 4 digits");
  CHECK(refused("15-11-05") == "'15-11-05' is not a date: the year is not 4 digits");
  CHECK(refused("-2015-11-05") == "'-2015-11-05' is not a date: the year is not 4 digits");
  CHECK(refused("2015/11/05") == "'2015/11/05' is not a date: " + form);
  CHECK(refused("2015-11") == "'2015-11' is not a date: " + form);
  CHECK(refused("2015-1-05") == "'2015-1-05' is not a date: the month is not 2 digits");
  CHECK(refused("2015-11-5") == "'2015-11-5' is not a date: the day is not 2 digits");
  CHECK(refused("2015-13-01") == "'2015-13-01' is not a date: the calendar has no such day");
  CHECK(refused("2015-00-01") == "'2015-00-01' is not a date: the calendar has no such day");
  CHECK(refused("2015-02-29") == "'2015-02-29' is not a date: the calendar has no such day");
  CHECK(refused("1900-02-29") == "'1900-02-29' is not a date: the calendar has no such day");
  CHECK(refused("2015-11-05T") == "'2015-11-05T' is not a date: the hour is not 2 digits");
  CHECK(refused("2015-11-05T24:00") == "'2015-11-05T24:00' is not a date: the hour 24 is above 23");
  CHECK(refused("2015-11-05T14") == "'2015-11-05T14' is not a date: " + form);
  CHECK(refused("2015-11-05T14:60") == "'2015-11-05T14:60' is not a date: the minute 60 is above 59");
  CHECK(refused("2015-11-05T14:30:60Z") == "'2015-11-05T14:30:60Z' is not a date: the second 60 is above 59");
  CHECK(refused("2015-11-05T14:30:00+01:00") == "'2015-11-05T14:30:00+01:00' is not a date: give it in UTC, without an offset");
  CHECK(refused("2015-11-05T14:30:00ZZ") == "'2015-11-05T14:30:00ZZ' is not a date: " + form);
  CHECK(refused("2015-11-05 ") == "'2015-11-05 ' is not a date: the hour is not 2 digits");
  CHECK(refused("2015-11-05T14:30:00.5Z") == "'2015-11-05T14:30:00.5Z' is not a date: " + form);
}
