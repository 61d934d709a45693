// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/digit_check.hpp>

#include <limits>
#include <string>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"

namespace {

std::string fault(scifi::digit_check& check, const scifi::digit& d, long position = 10) {
  const auto found = check.fault_of(d, position);
  return found ? std::string(found->field) + ": " + found->reason : "";
}

}  // namespace

TEST_CASE("a digit must name a channel that the detector has", "[io]") {
  scifi::digit_check check(scifi::mice::trackers(), "line");
  check.start_event(1);
  CHECK(fault(check, {{0, 1, 0, 0}, 1.0}).empty());
  CHECK(fault(check, {{1, 5, 2, 211}, 0.0}).empty());
  CHECK(fault(check, {{2, 1, 0, 0}, 1.0}) == "tracker: there is no tracker 2");
  CHECK(fault(check, {{-1, 1, 0, 0}, 1.0}) == "tracker: there is no tracker -1");
  CHECK(fault(check, {{0, 0, 0, 0}, 1.0}) == "station: there is no station 0 in tracker 0");
  CHECK(fault(check, {{1, 6, 0, 0}, 1.0}) == "station: there is no station 6 in tracker 1");
  CHECK(fault(check, {{0, 2, 3, 0}, 1.0}) == "plane: there is no plane 3 in station 2");
  CHECK(fault(check, {{0, 2, -1, 0}, 1.0}) == "plane: there is no plane -1 in station 2");
  CHECK(fault(check, {{0, 2, 0, 214}, 1.0}) == "channel: 214 is outside 0 .. 213");
  CHECK(fault(check, {{0, 2, 2, 212}, 1.0}) == "channel: 212 is outside 0 .. 211");
  CHECK(fault(check, {{0, 2, 0, -1}, 1.0}) == "channel: -1 is outside 0 .. 213");
}

TEST_CASE("the light of a digit must be finite and not negative", "[io]") {
  scifi::digit_check check(scifi::mice::trackers(), "line");
  CHECK(fault(check, {{0, 1, 0, 0}, -0.5}) == "npe: -0.500000 is negative");
  CHECK(fault(check, {{0, 1, 0, 0}, std::numeric_limits<double>::quiet_NaN()}) == "npe: is not a finite number");
  CHECK(fault(check, {{0, 1, 0, 0}, std::numeric_limits<double>::infinity()}) == "npe: is not a finite number");
}

TEST_CASE("a channel may have one digit an event", "[io]") {
  scifi::digit_check check(scifi::mice::trackers(), "line");
  check.start_event(2);
  CHECK(fault(check, {{0, 1, 0, 7}, 1.0}, 2).empty());
  CHECK(fault(check, {{0, 1, 1, 7}, 1.0}, 3).empty());
  CHECK(fault(check, {{1, 1, 0, 7}, 1.0}, 4).empty());
  CHECK(fault(check, {{0, 1, 0, 7}, 1.0}, 5) == "channel: a second digit of channel 7 in the event, the first is in line 2");
  check.start_event(6);
  CHECK(fault(check, {{0, 1, 0, 7}, 1.0}, 6).empty());
}
