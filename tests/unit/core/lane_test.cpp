// SPDX-License-Identifier: MPL-2.0
#include <scifi/core/lane.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("lanes are read and set alike in numbers, packs and masks", "[core]") {
  static_assert(lane_count<double> == 1);
  static_assert(lane_count<pack<float, 8>> == 8);
  static_assert(std::is_same_v<lane_type<double>, double> && std::is_same_v<lane_type<pack<float, 8>>, float>);
  double number = 1.0;
  set_lane(number, 0, 2.0);
  CHECK(lane_of(number, 0) == 2.0);
  bool truth = false;
  set_lane(truth, 0, true);
  CHECK(lane_of(truth, 0));
  pack<double, 4> several(1.0);
  set_lane(several, 2, 5.0);
  CHECK(lane_of(several, 2) == 5.0);
  CHECK(lane_of(several, 1) == 1.0);
  pack_mask<double, 4> truths(false);
  set_lane(truths, 3, true);
  CHECK(lane_of(truths, 3));
  CHECK_FALSE(lane_of(truths, 0));
}
