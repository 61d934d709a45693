// SPDX-License-Identifier: MPL-2.0
#include <scifi/space_point_to_candidate/search_trial.hpp>

#include <algorithm>
#include <limits>
#include <vector>

#include <scifi/core/random.hpp>

#include "support/catch.hpp"
#include "support/helix_points.hpp"

using namespace scifi;

namespace {

struct hand : test::helix_points {
  hand() {
    add(20.0, 0.12, -30.0, 0.05, 1.0 / 190.0);
    prepare();
  }
  search_trial trial() { return {setting, points, work}; }
};

constexpr double none = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("the points collected are the free ones of the tracker that are wanted, by station", "[space_point_to_candidate]") {
  hand h;
  h.points[1].tracker = 7;
  h.points[2].station = 99;
  h.work.cluster_used[9] = 1;
  h.points[4].npe = 1.0;
  search_trial t = h.trial();
  t.collect([](const space_point& p) { return p.station != 1; });
  CHECK(h.work.points[0].empty());
  CHECK(h.work.points[1].empty());
  CHECK(h.work.points[2].empty());
  CHECK(h.work.points[3] == std::vector<int>{3});
  CHECK(h.work.points[4] == std::vector<int>{4});
  CHECK_FALSE(t.dim(3));
  CHECK(t.dim(4));
  h.work.cluster_used[10] = 1;
  t.collect([](const space_point&) { return true; });
  CHECK(h.work.points[0] == std::vector<int>{0});
  CHECK(h.work.points[3].empty());
}

TEST_CASE("the points ahead are the same looked at one by one and by place, the true one among them", "[space_point_to_candidate]") {
  hand h;
  random_stream random(3, 0, 0);
  const space_point truth = h.points[3];
  const double w = h.setting.options.field / 190.0;
  for (const int others : {0, 5, 6, 7, 8, 9, 300}) {
    h.points.resize(5);
    for (int i = 0; i < others; ++i) {
      space_point p = truth;
      p.position += vector<double, 2>{random.uniform(-30.0, 30.0), random.uniform(-30.0, 30.0)};
      h.points.push_back(p);
    }
    h.prepare();
    search_trial t = h.trial();
    t.collect([](const space_point&) { return true; });
    t.stations = {0, 1, 2, 3, 4};
    t.chosen = {0, 1, 2};
    const chord_pair seen = t.chords(w);
    const outlook next(seen, t.turn(3), w);
    constexpr double limit = 9.0;
    std::vector<int> found, expected;
    t.each_ahead(seen, w, limit, [&](int i, double distance2) {
      CHECK(distance2 == Approx(next.distance2(t.arc(i))));
      found.push_back(i);
    });
    for (const int i : h.work.points[3])
      if (next.distance2(t.arc(i)) <= limit) expected.push_back(i);
    std::sort(found.begin(), found.end());
    CHECK(found == expected);
    CHECK(std::count(found.begin(), found.end(), 3) == 1);
  }
}

TEST_CASE("what is chosen becomes a candidate if its chi2 is small enough, in the arc and in all", "[space_point_to_candidate]") {
  hand h;
  h.points[2].chi2 = 4.0;
  search_trial t = h.trial();
  t.collect([](const space_point&) { return true; });
  t.stations = {0, 1, 2, 3, 4};
  t.chosen = {0, 1, 2, 3, 4};
  const arc_fit fit = t.refine(h.setting.options.field / 180.0, 3);
  CHECK(fit.curvature() == Approx(h.setting.options.field / 190.0).epsilon(0.02));
  t.finish(fit, 1e-9, none);
  t.finish(fit, 3.5, 4.0);
  CHECK(h.work.found.empty());
  t.finish(fit, 3.5, 6.0);
  REQUIRE(h.work.found.size() == 1);
  CHECK(h.work.found[0].chi2 == Approx(fit.chi2() + 4.0));
  CHECK(h.work.found[0].ndf == 10);
  t.finish(fit, 3.5, 6.0);  // the same again
  CHECK(h.work.found.size() == 1);
  CHECK(t.fits_left < h.setting.options.max_arc_fits);
}
