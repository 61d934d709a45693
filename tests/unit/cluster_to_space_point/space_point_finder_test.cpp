// SPDX-License-Identifier: MPL-2.0
#include <scifi/cluster_to_space_point/space_point_finder.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <scifi/core/random.hpp>
#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"
#include "support/ideal_clusters.hpp"

using namespace scifi;

namespace {

const tracker where = mice::trackers().trackers[mice::downstream];
const std::vector<surface> surfaces = surfaces_along(where, +1);

/// The clusters of a point in the first station, planes V, W, U.
void add_point(std::vector<cluster>& clusters, double x, double y, double npe = 10.0) {
  for (std::size_t i = 0; i < 3; ++i) clusters.push_back(test::ideal_cluster(where, surfaces[i], x, y, npe));
}

struct found {
  std::vector<space_point> points;
  bool complete;
};

found find(const space_point_finder& finder, std::vector<cluster>& clusters) {
  test::sort_clusters(clusters);
  found out;
  space_point_finder::buffers work;
  out.complete = finder(where, clusters, out.points, work);
  return out;
}

space_point_finder triplets_only() {
  space_point_finder f;
  f.doublets = false;
  return f;
}

bool has_point(const std::vector<space_point>& points, double x, double y) {
  return std::any_of(points.begin(), points.end(), [=](const space_point& p) { return std::hypot(p.position.x() - x, p.position.y() - y) < 1e-6; });
}

void shift(cluster& c, double channels) {
  c.channel += channels;
  c.alpha -= channels * 1.4945;
}

}  // namespace

TEST_CASE("three fibres that agree are a triplet, with its clusters in order of the planes", "[cluster_to_space_point]") {
  std::vector<cluster> clusters;
  add_point(clusters, 40.0, -30.0, 7.0);
  const found f = find({}, clusters);
  CHECK(f.complete);
  REQUIRE(f.points.size() == 1);
  const space_point& p = f.points[0];
  CHECK(has_point(f.points, 40.0, -30.0));
  CHECK(p.tracker == where.id);
  CHECK(p.station == 1);
  CHECK(p.chi2 == Approx(0.0).margin(1e-8));
  CHECK(p.npe == 21.0);
  REQUIRE(p.clusters.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) CHECK(clusters[static_cast<std::size_t>(p.clusters[i])].plane == static_cast<int>(i));
  CHECK(p.z == Approx((surfaces[0].z + surfaces[1].z + surfaces[2].z) / 3.0));
}

TEST_CASE("the channel numbers of a triplet add up to the sum of the central ones, within the tolerance", "[cluster_to_space_point]") {
  for (const double sign : {1.0, -1.0}) {
    for (const double off : {0.0, 1.0, 2.95, 3.05, 5.0}) {
      std::vector<cluster> clusters;
      add_point(clusters, -25.0, 60.0);
      shift(clusters[2], sign * off);
      space_point_finder finder = triplets_only();
      finder.channel_sum_tolerance = 3.0;
      INFO("off by " << sign * off);
      CHECK(find(finder, clusters).points.size() == (off < 3.0 ? 1u : 0u));
      finder.channel_sum_tolerance = 1.5;
      CHECK(find(finder, clusters).points.size() == (off < 1.5 ? 1u : 0u));
    }
  }
}

TEST_CASE("a plane with another central channel has another sum", "[cluster_to_space_point]") {
  tracker shifted = where;
  plane& u = shifted.stations[0].planes[2];
  u.central_channel += 10.0;
  std::vector<cluster> clusters;
  for (const surface& s : {surfaces[0], surfaces[1], surfaces[2]}) clusters.push_back(test::ideal_cluster(shifted, s, 12.0, 34.0));
  std::vector<space_point> points;
  space_point_finder::buffers work;
  CHECK(space_point_finder{}(shifted, clusters, points, work));
  REQUIRE(points.size() == 1);
  CHECK(has_point(points, 12.0, 34.0));
  CHECK(points[0].clusters.size() == 3);
}

TEST_CASE("used once, each cluster serves the best triplet it is in", "[cluster_to_space_point]") {
  space_point_finder once = triplets_only();
  once.use = cluster_use::once;
  random_stream random(3, 0, 0);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<cluster> clusters;
    for (int i = 0; i < 6; ++i) add_point(clusters, random.uniform(-60.0, 60.0), random.uniform(-60.0, 60.0));
    for (cluster& c : clusters) shift(c, random.uniform(-0.4, 0.4));
    space_point_finder shared = once;
    shared.use = cluster_use::shared;
    const found all = find(shared, clusters);
    const found chosen = find(once, clusters);
    std::set<int> used;
    for (const space_point& p : chosen.points) {
      for (const int c : p.clusters) CHECK(used.insert(c).second);
    }
    // Greedy by chi2: whatever was not chosen shares a cluster with something chosen that is at least as good.
    for (const space_point& p : all.points) {
      const auto same = [&p](const space_point& q) { return std::equal(p.clusters.begin(), p.clusters.end(), q.clusters.begin()); };
      if (std::any_of(chosen.points.begin(), chosen.points.end(), same)) continue;
      CHECK(std::any_of(chosen.points.begin(), chosen.points.end(), [&p](const space_point& q) {
        return q.chi2 <= p.chi2 && std::any_of(q.clusters.begin(), q.clusters.end(), [&p](int c) { return std::count(p.clusters.begin(), p.clusters.end(), c) > 0; });
      }));
    }
  }
}

TEST_CASE("shared, every consistent triplet is given and doublets come only from clusters in none", "[cluster_to_space_point]") {
  space_point_finder finder;
  finder.use = cluster_use::shared;
  std::vector<cluster> clusters;
  // Two points with the same U channel and channels of V and W near each other: four consistent triplets.
  add_point(clusters, 10.0, 20.0);
  add_point(clusters, 10.0, 21.5);
  clusters.pop_back();
  clusters.push_back(test::ideal_cluster(where, surfaces[0], -80.0, -60.0));
  clusters.push_back(test::ideal_cluster(where, surfaces[1], -80.0, -60.0));
  const found f = find(finder, clusters);
  CHECK(has_point(f.points, 10.0, 20.0));
  CHECK(std::count_if(f.points.begin(), f.points.end(), [](const space_point& p) { return p.clusters.size() == 3; }) == 4);
  CHECK(std::count_if(f.points.begin(), f.points.end(), [](const space_point& p) { return p.clusters.size() == 2; }) == 1);
  CHECK(has_point(f.points, -80.0, -60.0));
}

TEST_CASE("a doublet is made where a plane is silent, of any two views", "[cluster_to_space_point]") {
  for (std::size_t silent = 0; silent < 3; ++silent) {
    std::vector<cluster> clusters;
    add_point(clusters, 15.0, 45.0);
    clusters.erase(clusters.begin() + static_cast<std::ptrdiff_t>(silent));
    const found f = find({}, clusters);
    REQUIRE(f.points.size() == 1);
    CHECK(f.points[0].clusters.size() == 2);
    CHECK(has_point(f.points, 15.0, 45.0));
    CHECK(find(triplets_only(), clusters).points.empty());
  }
}

TEST_CASE("used once, brighter clusters are paired first", "[cluster_to_space_point]") {
  std::vector<cluster> clusters;
  clusters.push_back(test::ideal_cluster(where, surfaces[0], 30.0, 0.0, 9.0));
  clusters.push_back(test::ideal_cluster(where, surfaces[1], 30.0, 0.0, 9.0));
  clusters.push_back(test::ideal_cluster(where, surfaces[1], -30.0, 20.0, 2.0));
  space_point_finder finder;
  finder.use = cluster_use::once;
  const found f = find(finder, clusters);
  REQUIRE(f.points.size() == 1);
  CHECK(has_point(f.points, 30.0, 0.0));
}

TEST_CASE("crossings outside the tracker are not points", "[cluster_to_space_point]") {
  for (const double r : {140.0, 155.0, 170.0, 300.0}) {
    std::vector<cluster> clusters;
    add_point(clusters, r, 0.0);
    CHECK(find({}, clusters).points.size() == (r < where.active_radius ? 1u : 0u));
  }
  // Around the axis of the station, not of the tracker.
  tracker shifted = where;
  shifted.stations = {mice::fibre_station(1, {50.0, 0.0, 0.0})};
  std::vector<cluster> clusters;
  for (const surface& s : surfaces_along(shifted, +1)) clusters.push_back(test::ideal_cluster(shifted, s, 180.0, 0.0));
  std::vector<space_point> points;
  space_point_finder::buffers work;
  CHECK(space_point_finder{}(shifted, clusters, points, work));
  CHECK(points.size() == 1);
}

TEST_CASE("points come in order of the stations, those of other trackers are not made, those there before stay", "[cluster_to_space_point]") {
  std::vector<cluster> clusters;
  vector<double, 5> start;
  start << 10.0, 0.02, -5.0, 0.01, 0.005;
  test::add_ideal_track(where, start, 0.0, clusters);
  const tracker other = mice::trackers().trackers[mice::upstream];
  test::add_ideal_track(other, start, 0.0, clusters);
  test::sort_clusters(clusters);
  std::vector<space_point> points(2);
  space_point_finder::buffers work;
  CHECK(space_point_finder{}(where, clusters, points, work));
  REQUIRE(points.size() == 7);
  for (std::size_t i = 2; i < points.size(); ++i) {
    CHECK(points[i].station == static_cast<int>(i) - 1);
    CHECK(points[i].tracker == where.id);
    CHECK(points[i].clusters.size() == 3);
    for (const int c : points[i].clusters) CHECK(clusters[static_cast<std::size_t>(c)].tracker == where.id);
  }
  // The point of station i: positions of the exact line at its z, but for the slope between the planes.
  for (std::size_t i = 2; i < points.size(); ++i) CHECK(points[i].position.x() == Approx(10.0 + 0.02 * points[i].z).margin(0.02));
}

TEST_CASE("the number of points looked at is bounded, and reaching the bound is said", "[cluster_to_space_point]") {
  std::vector<cluster> clusters;
  random_stream random(5, 0, 0);
  for (int i = 0; i < 30; ++i) add_point(clusters, random.uniform(-60.0, 60.0), random.uniform(-60.0, 60.0));
  space_point_finder finder = triplets_only();
  finder.use = cluster_use::shared;
  const found all = find(finder, clusters);
  CHECK(all.complete);
  REQUIRE(all.points.size() > 30);
  finder.max_points_per_station = 10;
  const found some = find(finder, clusters);
  CHECK_FALSE(some.complete);
  CHECK(some.points.size() == 10);

  // Doublets are bounded too.
  std::erase_if(clusters, [](const cluster& c) { return c.plane == 2; });
  finder.doublets = true;
  const found pairs = find(finder, clusters);
  CHECK_FALSE(pairs.complete);
  CHECK(pairs.points.size() == 10);
}

TEST_CASE("stations of two or four planes give doublets, and nothing comes of nothing", "[cluster_to_space_point]") {
  std::vector<cluster> none;
  CHECK(find({}, none).complete);
  CHECK(find({}, none).points.empty());
  tracker two = where;
  two.stations.resize(1);
  two.stations[0].planes.resize(2);
  std::vector<cluster> clusters;
  for (const surface& s : surfaces_along(two, +1)) clusters.push_back(test::ideal_cluster(two, s, 5.0, 6.0));
  std::vector<space_point> points;
  space_point_finder::buffers work;
  CHECK(space_point_finder{}(two, clusters, points, work));
  REQUIRE(points.size() == 1);
  CHECK(has_point(points, 5.0, 6.0));
}
