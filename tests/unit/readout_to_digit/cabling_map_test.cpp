// SPDX-License-Identifier: MPL-2.0
#include <scifi/readout_to_digit/cabling_map.hpp>

#include "support/catch.hpp"

using scifi::cabling_map;
using scifi::cabling_result;
using scifi::channel_id;
using scifi::readout_channel;

TEST_CASE("a cable leads from the read-out to the detector and back", "[readout_to_digit]") {
  cabling_map map;
  CHECK(map.connect({7, 2, 61}, {1, 5, 2, 85}) == cabling_result::connected);
  CHECK(map.connect({7, 2, 62}, {0, 1, 0, 0}) == cabling_result::connected);
  CHECK(map.channel_of({7, 2, 61}) == channel_id{1, 5, 2, 85});
  CHECK(map.channel_of({7, 2, 62}) == channel_id{0, 1, 0, 0});
  CHECK(map.cable_of({1, 5, 2, 85}) == readout_channel{7, 2, 61});
  CHECK_FALSE(map.channel_of({7, 2, 63}).has_value());
  CHECK_FALSE(map.channel_of({99, 2, 61}).has_value());
  CHECK_FALSE(map.cable_of({1, 5, 2, 86}).has_value());
  REQUIRE(map.cables().size() == 2);
  CHECK(map.cables().begin()->first == channel_id{0, 1, 0, 0});
}

TEST_CASE("a connection that contradicts another one changes nothing", "[readout_to_digit]") {
  cabling_map map(scifi::readout_layout{2, 2, 8, 255});
  const readout_channel cable{1, 0, 3};
  const channel_id id{0, 2, 1, 17};
  REQUIRE(map.connect(cable, id) == cabling_result::connected);
  CHECK(map.connect(cable, id) == cabling_result::repeated);
  CHECK(map.connect(cable, {0, 2, 1, 18}) == cabling_result::cable_taken);
  CHECK(map.connect({1, 0, 4}, id) == cabling_result::channel_taken);
  for (const readout_channel outside : {readout_channel{2, 0, 3}, {1, 2, 3}, {1, 0, 8}, {-1, 0, 0}})
    CHECK(map.connect(outside, {0, 2, 1, 19}) == cabling_result::no_such_cable);
  CHECK(map.cables().size() == 1);
  CHECK(map.channel_of(cable) == id);
  CHECK(map.cable_of(id) == cable);
  CHECK_FALSE(map.channel_of({1, 0, 4}).has_value());
}
