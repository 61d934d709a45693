// SPDX-License-Identifier: MPL-2.0
#include <scifi/space_point_to_candidate/track_finder.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <scifi/cluster_to_space_point/space_point_finder.hpp>
#include <scifi/core/random.hpp>
#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"
#include "support/ideal_clusters.hpp"

using namespace scifi;

namespace {

constexpr double three_tesla = 3.0 * units::tesla;

const detector where = mice::trackers();
const tracker& tku = where.trackers[mice::upstream];
const tracker& tkd = where.trackers[mice::downstream];

struct found {
  std::vector<cluster> clusters;
  std::vector<space_point> points;
  std::vector<candidate> candidates;
  bool complete = true;
};

track_finder_options options_for(double field) {
  track_finder_options o;
  o.field = field;
  o.min_stations = field == 0.0 ? 3 : 4;
  return o;
}

found find(const tracker& t, const std::vector<cluster>& clusters, const track_finder_options& o) {
  found f{clusters, {}, {}, true};
  test::sort_clusters(f.clusters);
  space_point_finder::buffers memory;
  REQUIRE(space_point_finder{}(t, f.clusters, f.points, memory));
  const track_finder finder(t, o, muon_plus, highland_scattering{});
  track_finder::buffers work;
  f.complete = finder(f.points, f.clusters.size(), f.candidates, work);
  return f;
}

vector<double, 5> state(double x, double tx, double y, double ty, double q_over_pz) {
  vector<double, 5> s;
  s << x, tx, y, ty, q_over_pz;
  return s;
}

/// A track of this pt and pz (MeV/c) and charge that flies along the beam of the tracker and stays within the fiducial radius.
vector<double, 5> random_track(const tracker& t, double field, double pt, double pz, int charge, random_stream& random) {
  while (true) {
    const double azimuth = random.uniform(0.0, 2.0 * constants::pi);
    const vector<double, 5> s = state(random.uniform(-60.0, 60.0), pt / pz * std::cos(azimuth), random.uniform(-60.0, 60.0), pt / pz * std::sin(azimuth),
                                      charge * t.beam_direction / pz);
    bool inside = true;
    for (double z = 0.0; z <= 1102.0; z += 2.0) {
      const auto at = helix_propagator{field}.propagate(s, z).state;
      inside = inside && std::hypot(at[slope_state::x], at[slope_state::y]) < 145.0;
    }
    if (inside) return s;
  }
}

/// One candidate with a point in each of these many stations, whose seed is the track at its last point.
void check_candidate(const found& f, const tracker& t, double field, const vector<double, 5>& truth, std::size_t stations) {
  CHECK(f.complete);
  REQUIRE(f.candidates.size() == 1);
  const candidate& c = f.candidates[0];
  CHECK(c.tracker == t.id);
  CHECK(c.space_points.size() == stations);
  CHECK(c.shape == (field == 0.0 ? track_shape::line : track_shape::helix));
  for (std::size_t i = 1; i < c.space_points.size(); ++i)
    CHECK(f.points[static_cast<std::size_t>(c.space_points[i - 1])].z < f.points[static_cast<std::size_t>(c.space_points[i])].z);
  CHECK(c.z == f.points[static_cast<std::size_t>(c.space_points[c.space_points.size() - 1])].z);
  const auto expected = helix_propagator{field}.propagate(truth, c.z).state;
  for (const int i : {slope_state::x, slope_state::tx, slope_state::y, slope_state::ty, slope_state::q_over_pz}) {
    if (field == 0.0 && i == slope_state::q_over_pz) continue;
    INFO(slope_state::names[static_cast<std::size_t>(i)] << ' ' << c.seed.mean[i] << ", true " << expected[i] << ", sigma " << kalman::sigma(c.seed, i));
    // There is no noise but that the slope between the planes of a station is not known.
    CHECK(std::abs(c.seed.mean[i] - expected[i]) < 2.0 * kalman::sigma(c.seed, i));
  }
}

}  // namespace

TEST_CASE("helices without noise are found with their curvature: both trackers, charges and directions of the field", "[space_point_to_candidate]") {
  random_stream random(1, 0, 0);
  for (const tracker* t : {&tku, &tkd}) {
    for (const double field : {three_tesla, -three_tesla, 4.0 * units::tesla}) {
      for (const int charge : {1, -1}) {
        for (int i = 0; i < 10; ++i) {
          const double pz = random.uniform(120.0, 280.0);
          const double pt = random.uniform(10.0, std::min(80.0, 0.5 * pz));
          INFO(t->name << ", field " << field << ", charge " << charge << ", pt " << pt << ", pz " << pz);
          const vector<double, 5> truth = random_track(*t, field, pt, pz, charge, random);
          std::vector<cluster> clusters;
          test::add_ideal_track(*t, truth, field, clusters);
          const found f = find(*t, clusters, options_for(field));
          check_candidate(f, *t, field, truth, 5);
          CHECK(f.candidates[0].ndf == 2 * 5 - 5 + 5);
          CHECK(f.candidates[0].seed.mean[slope_state::q_over_pz] * charge * t->beam_direction > 0.0);
        }
      }
    }
  }
}

TEST_CASE("tracks that hardly bend are found with all their points", "[space_point_to_candidate]") {
  random_stream random(2, 0, 0);
  for (const double pt : {0.0, 0.5, 1.0, 2.0, 3.0, 5.0}) {
    for (int i = 0; i < 10; ++i) {
      const double pz = random.uniform(120.0, 280.0);
      INFO("pt " << pt << ", pz " << pz);
      const vector<double, 5> truth = random_track(tkd, three_tesla, pt, pz, 1, random);
      std::vector<cluster> clusters;
      test::add_ideal_track(tkd, truth, three_tesla, clusters);
      const found f = find(tkd, clusters, options_for(three_tesla));
      REQUIRE(f.candidates.size() == 1);
      CHECK(f.candidates[0].space_points.size() == 5);
      CHECK(std::isfinite(f.candidates[0].seed.mean.sum()));
    }
  }
}

TEST_CASE("more than a whole turn is not taken for less", "[space_point_to_candidate]") {
  random_stream random(3, 0, 0);
  for (const double field : {three_tesla, 4.0 * units::tesla}) {
    for (double pz = 70.0; pz <= 110.0; pz += 2.5) {
      const double pt = random.uniform(15.0, 35.0);
      INFO("field " << field << ", pt " << pt << ", pz " << pz);
      const vector<double, 5> truth = random_track(tkd, field, pt, pz, 1, random);
      std::vector<cluster> clusters;
      test::add_ideal_track(tkd, truth, field, clusters);
      check_candidate(find(tkd, clusters, options_for(field)), tkd, field, truth, 5);
    }
  }
}

TEST_CASE("a helix is found when any one station is silent, and not when two are", "[space_point_to_candidate]") {
  random_stream random(4, 0, 0);
  for (int silent = 1; silent <= 5; ++silent) {
    for (int i = 0; i < 5; ++i) {
      const vector<double, 5> truth = random_track(tkd, three_tesla, random.uniform(15.0, 60.0), random.uniform(130.0, 250.0), 1, random);
      std::vector<cluster> clusters;
      test::add_ideal_track(tkd, truth, three_tesla, clusters);
      std::erase_if(clusters, [silent](const cluster& c) { return c.station == silent; });
      INFO("silent " << silent);
      check_candidate(find(tkd, clusters, options_for(three_tesla)), tkd, three_tesla, truth, 4);
      std::erase_if(clusters, [silent](const cluster& c) { return c.station == silent % 5 + 1; });
      CHECK(find(tkd, clusters, options_for(three_tesla)).candidates.empty());
    }
  }
}

TEST_CASE("straight lines are found from five, four and three stations, with the momentum and charge assumed", "[space_point_to_candidate]") {
  random_stream random(5, 0, 0);
  for (const tracker* t : {&tku, &tkd}) {
    for (const std::set<int>& silent : {std::set<int>{}, {1}, {3}, {5}, {1, 2}, {2, 4}, {4, 5}, {1, 5}}) {
      const vector<double, 5> truth = state(random.uniform(-30.0, 30.0), random.uniform(-0.08, 0.08), random.uniform(-30.0, 30.0), random.uniform(-0.08, 0.08), 0.005);
      std::vector<cluster> clusters;
      test::add_ideal_track(*t, truth, 0.0, clusters);
      std::erase_if(clusters, [&silent](const cluster& c) { return silent.count(c.station) != 0; });
      track_finder_options o = options_for(0.0);
      o.line_charge = -1;
      o.line_momentum = 170.0;
      const found f = find(*t, clusters, o);
      check_candidate(f, *t, 0.0, truth, 5 - silent.size());
      CHECK(f.candidates[0].seed.mean[slope_state::q_over_pz] == Approx(-t->beam_direction / 170.0).epsilon(1e-2));
    }
  }
  // Two points make no track.
  std::vector<cluster> clusters;
  test::add_ideal_track(tkd, state(0.0, 0.01, 0.0, 0.01, 0.005), 0.0, clusters);
  std::erase_if(clusters, [](const cluster& c) { return c.station > 2; });
  CHECK(find(tkd, clusters, options_for(0.0)).candidates.empty());
}

TEST_CASE("tracks that cross are told apart", "[space_point_to_candidate]") {
  random_stream random(6, 0, 0);
  for (const double field : {three_tesla, 0.0}) {
    for (int i = 0; i < 20; ++i) {
      const double pt = field == 0.0 ? 12.0 : 40.0;
      const vector<double, 5> a = random_track(tkd, field, pt, 200.0, 1, random);
      const vector<double, 5> b = random_track(tkd, field, pt, 160.0, field == 0.0 ? 1 : -1, random);
      std::vector<cluster> clusters;
      test::add_ideal_track(tkd, a, field, clusters);
      test::add_ideal_track(tkd, b, field, clusters);
      const found f = find(tkd, clusters, options_for(field));
      REQUIRE(f.candidates.size() == 2);
      std::multiset<int> seen;
      for (const candidate& c : f.candidates) {
        CHECK(c.space_points.size() == 5);
        for (const int p : c.space_points) seen.insert(p);
      }
      // Each is one of the two.
      for (const vector<double, 5>& truth : {a, b}) {
        CHECK(std::count_if(f.candidates.begin(), f.candidates.end(), [&](const candidate& c) {
                const auto at = helix_propagator{field}.propagate(truth, c.z).state;
                return std::hypot(c.seed.mean[slope_state::x] - at[slope_state::x], c.seed.mean[slope_state::y] - at[slope_state::y]) < 1.0 &&
                       std::hypot(c.seed.mean[slope_state::tx] - at[slope_state::tx], c.seed.mean[slope_state::ty] - at[slope_state::ty]) < 0.02;
              }) == 1);
      }
    }
  }
}

TEST_CASE("points at random are no track", "[space_point_to_candidate]") {
  random_stream random(7, 0, 0);
  int found_by_chance = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<cluster> clusters;
    for (int station = 0; station < 5; ++station) {
      const double x = random.uniform(-100.0, 100.0), y = random.uniform(-100.0, 100.0);
      for (const surface& s : surfaces_along(tkd, +1))
        if (s.station == station + 1) clusters.push_back(test::ideal_cluster(tkd, s, x, y));
    }
    found_by_chance += static_cast<int>(find(tkd, clusters, options_for(three_tesla)).candidates.size());
  }
  // Each needs two or three further stations within a few mm by chance.
  CHECK(found_by_chance <= 4);
}

TEST_CASE("the search is bounded, and reaching the bound is said", "[space_point_to_candidate]") {
  random_stream random(8, 0, 0);
  std::vector<cluster> clusters;
  for (int i = 0; i < 4; ++i) test::add_ideal_track(tkd, random_track(tkd, three_tesla, 30.0, 200.0, 1, random), three_tesla, clusters);
  track_finder_options o = options_for(three_tesla);
  CHECK(find(tkd, clusters, o).complete);
  CHECK(find(tkd, clusters, o).candidates.size() == 4);
  o.max_arc_fits = 10;
  CHECK_FALSE(find(tkd, clusters, o).complete);
}

TEST_CASE("points of another tracker are left alone, candidates are appended, nothing comes of nothing", "[space_point_to_candidate]") {
  random_stream random(9, 0, 0);
  std::vector<cluster> clusters;
  test::add_ideal_track(tku, random_track(tku, three_tesla, 30.0, 200.0, 1, random), three_tesla, clusters);
  found f = find(tku, clusters, options_for(three_tesla));
  REQUIRE(f.candidates.size() == 1);
  const track_finder other(tkd, options_for(three_tesla), muon_plus, highland_scattering{});
  track_finder::buffers work;
  CHECK(other(f.points, f.clusters.size(), f.candidates, work));
  CHECK(f.candidates.size() == 1);
  CHECK(other({}, 0, f.candidates, work));
  CHECK(f.candidates.size() == 1);
  const track_finder same(tku, options_for(three_tesla), muon_plus, highland_scattering{});
  CHECK(same(f.points, f.clusters.size(), f.candidates, work));
  REQUIRE(f.candidates.size() == 2);
  CHECK(f.candidates[0].seed.mean == f.candidates[1].seed.mean);
}
