// SPDX-License-Identifier: MPL-2.0
#include <scifi/space_point_to_candidate/combination_search.hpp>

#include <vector>

#include "support/catch.hpp"
#include "support/helix_points.hpp"

using namespace scifi;

namespace {

struct bench : test::helix_points {
  explicit bench(int helices) {
    double x = 20.0, q_over_pz = 1.0 / 190.0;
    for (int i = 0; i < helices; ++i, x -= 70.0, q_over_pz *= -1.1) add(x, 0.12, -30.0, 0.05, q_over_pz);
    prepare();
  }
};

}  // namespace

TEST_CASE("a search through all stations finds each helix, with its curvature, and nothing better", "[space_point_to_candidate]") {
  bench b(2);
  combination_search search(b.setting, b.points, b.work);
  search(5, true);
  int found = 0;
  for (const candidate& c : b.work.found) {
    if (!bench::pure(c)) continue;
    ++found;
    CHECK(c.chi2 < 1.0);
    CHECK(c.ndf == 5 + 5);
    const double expected = c.space_points[0] < 5 ? 1.0 / 190.0 : -1.1 / 190.0;
    CHECK(c.seed.mean[slope_state::q_over_pz] == Approx(expected).epsilon(0.02));
  }
  CHECK(found == 2);
  CHECK(search.complete());
}

TEST_CASE("a point with two clusters taken is left out, one with a single one is not", "[space_point_to_candidate]") {
  bench b(1);
  b.work.cluster_used[6] = 1;  // third station
  combination_search search(b.setting, b.points, b.work);
  search(5, true);
  CHECK(b.work.found.size() == 1);
  b.work.cluster_used[7] = 1;
  search(5, true);
  CHECK(b.work.found.empty());
  search(4, true);
  REQUIRE(b.work.found.size() == 1);
  CHECK(b.work.found[0].space_points.size() == 4);
}

TEST_CASE("a candidate may have one point as dim as thermal noise, anywhere, but not two", "[space_point_to_candidate]") {
  for (std::size_t first = 0; first < 5; ++first) {
    bench b(1);
    combination_search search(b.setting, b.points, b.work);
    b.points[first].npe = 3 * 2.5;
    search(5, false);
    CHECK(b.work.found.size() == 1);
    for (std::size_t second = first + 1; second < 5; ++second) {
      b.points[second].npe = 3 * 2.5;
      CAPTURE(first, second);
      search(5, false);
      CHECK(b.work.found.empty());
      search(4, false);  // four of the five without one of the two, each with one: two choices
      CHECK(b.work.found.size() == 2);
      b.points[second].npe = 3 * 12.0;
    }
  }
}

TEST_CASE("four of five stations are five choices", "[space_point_to_candidate]") {
  bench b(1);
  combination_search search(b.setting, b.points, b.work);
  search(4, true);
  CHECK(b.work.found.size() == 5);
}

TEST_CASE("points of another tracker are not looked at, and a spent budget is said", "[space_point_to_candidate]") {
  bench b(1);
  for (space_point& p : b.points) p.tracker = 0;
  combination_search elsewhere(b.setting, b.points, b.work);
  elsewhere(5, true);
  CHECK(b.work.found.empty());

  bench poor(2);
  poor.setting.options.max_arc_fits = 3;
  combination_search search(poor.setting, poor.points, poor.work);
  search(5, false);
  CHECK_FALSE(search.complete());
}

TEST_CASE("looking has a bound of its own: points that are too dim for any arc fit", "[space_point_to_candidate]") {
  bench b(2);
  for (space_point& p : b.points) p.npe = 0.0;
  b.setting.options.max_looks = 1000;
  combination_search enough(b.setting, b.points, b.work);
  enough(5, false);
  CHECK(enough.complete());
  b.setting.options.max_looks = 5;
  combination_search poor(b.setting, b.points, b.work);
  poor(5, false);
  CHECK_FALSE(poor.complete());
}

TEST_CASE("the first, tight search leaves out points whose crossing is worse than tight_point_chi2, the wide one does not", "[space_point_to_candidate]") {
  bench b(1);
  combination_search search(b.setting, b.points, b.work);
  b.points[2].chi2 = b.setting.options.tight_point_chi2;
  search(5, true);
  CHECK(b.work.found.size() == 1);
  b.points[2].chi2 += 0.1;
  search(5, true);
  CHECK(b.work.found.empty());
  search(5, false);
  REQUIRE(b.work.found.size() == 1);
  CHECK(b.work.found[0].chi2 >= b.points[2].chi2);
}
