// SPDX-License-Identifier: MPL-2.0
#include <scifi/readout_to_digit/bad_channels.hpp>

#include "support/catch.hpp"

using scifi::bad_channels;
using scifi::readout_channel;

TEST_CASE("the channels that were marked are bad, and no others", "[readout_to_digit]") {
  bad_channels bad;
  CHECK(bad.mark({0, 0, 64}));
  CHECK(bad.mark({15, 3, 126}));
  CHECK(bad.mark({0, 0, 64}));
  CHECK(bad.size() == 2);
  CHECK(bad.contains({0, 0, 64}));
  CHECK(bad.contains({15, 3, 126}));
  for (const readout_channel good : {readout_channel{0, 0, 63}, {0, 0, 65}, {0, 1, 64}, {1, 0, 64}}) CHECK_FALSE(bad.contains(good));
}

TEST_CASE("a channel that does not exist cannot be bad", "[readout_to_digit]") {
  bad_channels bad;
  for (const readout_channel outside : {readout_channel{16, 0, 0}, {0, 4, 0}, {0, 0, 128}, {-1, 0, 0}}) {
    CHECK_FALSE(bad.mark(outside));
    CHECK_FALSE(bad.contains(outside));
  }
  CHECK(bad.size() == 0);
}
