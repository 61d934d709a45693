// SPDX-License-Identifier: MPL-2.0
#include <scifi/kalman/each_index.hpp>

#include <vector>

#include "support/catch.hpp"

namespace {

template <int N>
std::vector<int> visited() {
  std::vector<int> out;
  scifi::kalman::detail::each_index<N>([&out](int i) { out.push_back(i); });
  return out;
}

}  // namespace

TEST_CASE("every index is visited once and in order, unrolled or not", "[kalman]") {
  CHECK(visited<0>().empty());
  CHECK(visited<1>() == std::vector{0});
  CHECK(visited<3>() == std::vector{0, 1, 2});
  CHECK(visited<5>() == std::vector{0, 1, 2, 3, 4});
}
