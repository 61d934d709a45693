// SPDX-License-Identifier: MPL-2.0
#include <scifi/core/inline_vector.hpp>

#include <numeric>
#include <type_traits>

#include "support/catch.hpp"

using scifi::inline_vector;

TEST_CASE("an inline vector takes its capacity and not one more", "[core]") {
  inline_vector<int, 3> v;
  CHECK(v.empty());
  CHECK(v.capacity() == 3);
  for (int i = 0; i < 3; ++i) CHECK(v.push_back(10 * i));
  CHECK_FALSE(v.push_back(99));
  REQUIRE(v.size() == 3);
  CHECK(v[0] == 0);
  CHECK(v[2] == 20);
  CHECK(v.back() == 20);
}

TEST_CASE("an inline vector shrinks, is emptied and filled again", "[core]") {
  inline_vector<int, 4> v{7, 8, 9};
  v.pop_back();
  CHECK(v.size() == 2);
  CHECK(v.back() == 8);
  CHECK(v.push_back(5));
  CHECK(v[2] == 5);
  v.clear();
  CHECK(v.empty());
  CHECK(v.begin() == v.end());
  CHECK(v.push_back(1));
  CHECK(v.size() == 1);
}

TEST_CASE("an inline vector is walked and written through like any range", "[core]") {
  inline_vector<int, 8> v{1, 2, 3};
  CHECK(std::accumulate(v.begin(), v.end(), 0) == 6);
  for (int& x : v) x *= 2;
  const auto& same = v;
  CHECK(std::accumulate(same.begin(), same.end(), 0) == 12);
  CHECK(same.back() == 6);
  v[1] = 0;
  CHECK(same[1] == 0);
}

TEST_CASE("an inline vector is a plain value, also at compile time", "[core]") {
  static_assert(std::is_trivially_copyable_v<inline_vector<double, 5>>);
  constexpr inline_vector<int, 2> v{4, 5};
  static_assert(v.size() == 2 && v[1] == 5);
  inline_vector<int, 2> copy = v;
  copy[0] = -1;
  CHECK(v[0] == 4);
  CHECK(copy[0] == -1);
}
