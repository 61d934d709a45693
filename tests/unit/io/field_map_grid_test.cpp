// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/field_map_grid.hpp>

#include <cmath>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/temporary_folder.hpp"

using namespace scifi;
using namespace scifi::test;
using scifi::detail::field_map_grid;
using scifi::detail::field_map_text;

namespace {

field_map_grid<3> grid_of(const std::string& mirrors, const std::string& rows) {
  const temporary_folder folder;
  return field_map_grid<3>(field_map_text(folder.file("a", "scifi field map\ngrid cartesian\nlength mm\nfield T\n" + mirrors + "columns x y z bx by bz\n" + rows)));
}

/// Points of x in `xs`, y in -1..1, z in 10..30, with components that tell where they stand.
std::string rows_at(const std::vector<int>& xs) {
  std::string out;
  for (const int z : {30, 10, 20})
    for (const int x : xs)
      for (const int y : {-1, 1, 0}) out += std::to_string(x) + ' ' + std::to_string(y) + ' ' + std::to_string(z) + ' ' + std::to_string(x) + ' ' + std::to_string(y) + ' ' + std::to_string(z + x) + '\n';
  return out;
}

}  // namespace

TEST_CASE("points in any order find their place", "[io]") {
  const auto grid = grid_of("", rows_at({4, 0, 2, 6}));
  CHECK(grid.axes[0].count == 4);
  CHECK(grid.axes[0].first == 0.0);
  CHECK(grid.axes[0].step == 2.0);
  CHECK(grid.axes[1].first == -1.0);
  CHECK(grid.axes[2].last() == 30.0);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& b = grid.values[(i * 3 + j) * 3 + k];
        CHECK(b[0] == Approx(grid.axes[0].at(i) * units::tesla));
        CHECK(b[1] == Approx(grid.axes[1].at(j) * units::tesla));
        CHECK(b[2] == Approx((grid.axes[2].at(k) + grid.axes[0].at(i)) * units::tesla));
      }
}

TEST_CASE("a mirrored half is unfolded, from above the plane and from below", "[io]") {
  const std::string mirror = "mirror x bx odd by even bz even\n";
  for (const std::vector<int>& xs : {std::vector<int>{0, 2, 4}, std::vector<int>{-4, -2, 0}}) {
    const auto grid = grid_of(mirror, rows_at(xs));
    CHECK(grid.axes[0].count == 5);
    CHECK(grid.axes[0].first == -4.0);
    CHECK(grid.axes[0].step == 2.0);
    const double side = xs.front() == 0 ? 1.0 : -1.0;
    for (std::size_t i = 0; i < 5; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        const auto& b = grid.values[(i * 3 + j) * 3 + 2];
        const double x = grid.axes[0].at(i);
        CHECK(b[0] == Approx(x * units::tesla).margin(1e-15));
        CHECK(b[1] == Approx(grid.axes[1].at(j) * units::tesla).margin(1e-15));
        CHECK(b[2] == Approx((30.0 + side * std::abs(x)) * units::tesla));
      }
  }
}

TEST_CASE("places that decimals round are still evenly spaced", "[io]") {
  std::string thirds;
  for (const char* x : {"0", "33.333", "66.667", "100"})
    for (const char* y : {"0", "1", "2"})
      for (const char* z : {"0", "1", "2"}) thirds += std::string(x) + ' ' + y + ' ' + z + " 0 0 1\n";
  CHECK(grid_of("", thirds).axes[0].step == Approx(100.0 / 3.0));
}
