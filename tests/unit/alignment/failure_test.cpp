// SPDX-License-Identifier: MPL-2.0
#include <scifi/alignment/failure.hpp>

#include <set>
#include <string_view>

#include "support/catch.hpp"

using scifi::alignment::describe;
using scifi::alignment::failure;

TEST_CASE("every failure of an alignment has a clause of its own", "[alignment]") {
  std::set<std::string_view> said;
  constexpr int failures = static_cast<int>(failure::undetermined_parameters) + 1;
  for (int i = 0; i < failures; ++i) said.insert(describe(static_cast<failure>(i)));
  CHECK(said.size() == failures);
  CHECK(said.count("unknown failure") == 0);
}
