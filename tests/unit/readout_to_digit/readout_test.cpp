// SPDX-License-Identifier: MPL-2.0
#include <scifi/readout_to_digit/readout.hpp>

#include <cstddef>
#include <set>
#include <utility>

#include "support/catch.hpp"

using scifi::readout_channel;
using scifi::readout_layout;

TEST_CASE("every read-out channel has a place of its own in a table", "[readout_to_digit]") {
  constexpr readout_layout layout{3, 2, 5, 255};
  static_assert(layout.size() == 30);
  std::set<std::size_t> places;
  for (int board = 0; board < 3; ++board)
    for (int bank = 0; bank < 2; ++bank)
      for (int channel = 0; channel < 5; ++channel) {
        const auto at = layout.index({board, bank, channel});
        REQUIRE(at.has_value());
        CHECK(*at < layout.size());
        places.insert(*at);
      }
  CHECK(places.size() == 30);
}

TEST_CASE("a read-out channel outside the layout has no place", "[readout_to_digit]") {
  constexpr readout_layout layout;
  for (const readout_channel r : {readout_channel{16, 0, 0}, {-1, 0, 0}, {0, 4, 0}, {0, -1, 0}, {0, 0, 128}, {0, 0, -1}, {1 << 30, 1 << 30, 1 << 30}}) {
    CHECK_FALSE(layout.contains(r));
    CHECK_FALSE(layout.index(r).has_value());
  }
  CHECK(layout.index({15, 3, 127}) == layout.size() - 1);
}

TEST_CASE("banks counted through all boards are those of their boards, one after the other", "[readout_to_digit]") {
  constexpr readout_layout layout;
  CHECK(layout.all_banks() == 64);
  CHECK(layout.counted_through(0, 5) == readout_channel{0, 0, 5});
  CHECK(layout.counted_through(7, 127) == readout_channel{1, 3, 127});
  CHECK(layout.counted_through(63, 0) == readout_channel{15, 3, 0});
  for (const auto& [bank, channel] : {std::pair{64, 0}, {-1, 0}, {0, 128}, {0, -1}}) CHECK_FALSE(layout.counted_through(bank, channel).has_value());
}
