// SPDX-License-Identifier: MPL-2.0
#include <scifi/space_point_to_candidate/combination_search.hpp>

#include <vector>

#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/track_model/helix_propagator.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

const double field = 3.0 * units::tesla;

/// The five points of an exact helix, each of three clusters of its own, numbered on from `first_cluster`.
void add_helix(const vector<double, 5>& start, int first_cluster, std::vector<space_point>& points) {
  const tracker t = mice::trackers().trackers[1];
  for (const station& s : t.stations) {
    space_point p;
    p.tracker = t.id;
    p.station = s.id;
    p.z = s.in_tracker.origin.z() + 1.0;
    const vector<double, 5> at = helix_propagator{field}.propagate(start, p.z).state;
    p.position = {at[slope_state::x], at[slope_state::y]};
    p.covariance = 0.12 * matrix<double, 2, 2>::Identity();
    p.npe = 36.0;
    for (int i = 0; i < 3; ++i) p.clusters.push_back(first_cluster++);
    points.push_back(p);
  }
}

struct bench {
  search_setting setting;
  std::vector<space_point> points;
  search_buffers work;

  explicit bench(int helices) {
    const tracker t = mice::trackers().trackers[1];
    setting = {t.id, t.beam_direction, {}, station_scattering(t, muon_plus, highland_scattering{}), {}};
    setting.options.field = field;
    for (const station& s : t.stations) setting.stations.push_back(s.id);
    vector<double, 5> start;
    start << 20.0, 0.12, -30.0, 0.05, 1.0 / 190.0;
    for (int i = 0; i < helices; ++i) {
      add_helix(start, 15 * i, points);
      start[slope_state::x] -= 70.0;
      start[slope_state::q_over_pz] *= -1.1;
    }
    for (const space_point& p : points) work.arc_points.push_back({{p.position.x(), p.position.y()}, 0.12, p.z});
    work.points.resize(setting.stations.size());
    work.cluster_used.assign(points.size() * 3, 0);
  }
};

/// True if the candidate's points are those of one helix.
bool pure(const candidate& c) {
  for (const int point : c.space_points)
    if (point / 5 != c.space_points[0] / 5) return false;
  return true;
}

}  // namespace

TEST_CASE("a search through all stations finds each helix, with its curvature, and nothing better", "[space_point_to_candidate]") {
  bench b(2);
  combination_search search(b.setting, b.points, b.work);
  search(5, true);
  int found = 0;
  for (const candidate& c : b.work.found) {
    if (!pure(c)) continue;
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
