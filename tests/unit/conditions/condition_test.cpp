// SPDX-License-Identifier: MPL-2.0
#include <scifi/conditions/condition.hpp>

#include <set>
#include <string_view>

#include "support/catch.hpp"

TEST_CASE("every kind has a name of its own, by which it is found", "[conditions]") {
  std::set<std::string_view> names;
  for (const scifi::condition_kind kind : scifi::condition_kinds) {
    names.insert(name_of(kind));
    CHECK(scifi::condition_kind_from_name(name_of(kind)) == kind);
  }
  CHECK(names == std::set<std::string_view>{"geometry", "calibration", "cabling", "bad_channels", "alignment"});
  CHECK_FALSE(scifi::condition_kind_from_name("Geometry"));
  CHECK_FALSE(scifi::condition_kind_from_name(""));
}
