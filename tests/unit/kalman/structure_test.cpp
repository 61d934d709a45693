// SPDX-License-Identifier: MPL-2.0
#include <scifi/kalman/structure.hpp>

#include <array>

#include "support/catch.hpp"

namespace kalman = scifi::kalman;

namespace {

struct says_nothing {};
struct says_two {
  static constexpr std::array unit_columns{0, 2};
  static constexpr std::array seen_components{1};
};
struct passes_on {
  static constexpr auto unit_columns = kalman::unit_columns<says_two>;
};

}  // namespace

TEST_CASE("what models declare of their matrices becomes bits, what they do not is dense", "[kalman]") {
  static_assert(kalman::detail::unit_columns_of<says_nothing>() == 0u);
  static_assert(kalman::detail::unit_columns_of<says_two>() == 0b101u);
  static_assert(kalman::detail::unit_columns_of<passes_on>() == 0b101u);
  static_assert(kalman::detail::seen_components_of<says_nothing>() == ~0u);
  static_assert(kalman::detail::seen_components_of<says_two>() == 0b10u);
  CHECK(kalman::detail::has_bit(0b100u, 2));
  CHECK_FALSE(kalman::detail::has_bit(0b100u, 1));
}
