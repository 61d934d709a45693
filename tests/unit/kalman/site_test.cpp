// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <optional>
#include <type_traits>

#include <scifi/kalman/site.hpp>

namespace kalman = scifi::kalman;

TEST_CASE("a site deduces its types and may have no step to take", "[kalman]") {
  const kalman::site s{2.0, 3};
  STATIC_REQUIRE(std::is_same_v<std::remove_const_t<decltype(s)>, kalman::site<double, int>>);
  const kalman::site<std::optional<double>, int> first{kalman::at_start, 3};
  CHECK_FALSE(first.step.has_value());
}
