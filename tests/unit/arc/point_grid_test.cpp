// SPDX-License-Identifier: MPL-2.0
#include <scifi/arc/point_grid.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <scifi/core/random.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("a grid gives the points of a box, each once, wherever the box is", "[arc]") {
  random_stream random(1, 0, 0);
  point_grid grid;
  for (const int size : {0, 1, 2, 9, 100, 3000}) {
    std::vector<arc_point> where;
    std::vector<int> points;
    for (int i = 0; i < 2 * size; ++i) {
      where.push_back({{random.uniform(-150.0, 150.0), random.uniform(-100.0, 40.0)}, 0.1, 0.0});
      if (i % 2 == 1) points.push_back(i);
    }
    grid.fill(points, where);
    CHECK(grid.empty() == points.empty());
    for (int k = 0; k < 50; ++k) {
      const planar<double> place{random.uniform(-300.0, 300.0), random.uniform(-200.0, 200.0)};
      const planar<double> reach{random.uniform(0.0, 100.0), k == 0 ? std::numeric_limits<double>::infinity() : random.uniform(0.0, 100.0)};
      std::vector<int> found, expected;
      grid.near(place, reach, [&found](int p) { found.push_back(p); });
      for (const int p : points) {
        const planar<double> off = where[static_cast<std::size_t>(p)].position - place;
        if (std::abs(off.x) <= reach.x && std::abs(off.y) <= reach.y) expected.push_back(p);
      }
      std::sort(found.begin(), found.end());
      CHECK(found == expected);
    }
  }
  grid.clear();
  CHECK(grid.empty());
}

TEST_CASE("a place or reach that is no number finds nothing and does no harm", "[arc]") {
  const std::vector<arc_point> where{{{1.0, 2.0}, 0.1, 0.0}, {{-3.0, 5.0}, 0.1, 0.0}};
  point_grid grid;
  grid.fill(std::vector<int>{0, 1}, where);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  int found = 0;
  grid.near({nan, 2.0}, {1.0, 1.0}, [&found](int) { ++found; });
  grid.near({1.0, 2.0}, {nan, nan}, [&found](int) { ++found; });
  CHECK(found == 0);
}
