// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <set>
#include <string_view>

#include "support/catch.hpp"

namespace scifi::test {

/// A state space has one name, unit and title for each component; names and titles differ from one another.
template <class StateSpace>
void check_state_space() {
  constexpr auto n = static_cast<std::size_t>(StateSpace::dimension);
  STATIC_REQUIRE(StateSpace::names.size() == n);
  STATIC_REQUIRE(StateSpace::units.size() == n);
  STATIC_REQUIRE(StateSpace::titles.size() == n);
  std::set<std::string_view> names, titles;
  for (std::size_t i = 0; i < n; ++i) {
    CHECK_FALSE(StateSpace::units[i].empty());
    names.insert(StateSpace::names[i]);
    titles.insert(StateSpace::titles[i]);
  }
  CHECK(names.size() == n);
  CHECK(titles.size() == n);
  CHECK(names.count("") == 0);
  CHECK(titles.count("") == 0);
}

}  // namespace scifi::test
