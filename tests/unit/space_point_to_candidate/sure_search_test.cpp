// SPDX-License-Identifier: MPL-2.0
#include <scifi/space_point_to_candidate/sure_search.hpp>

#include <set>

#include <scifi/core/random.hpp>

#include "support/catch.hpp"
#include "support/helix_points.hpp"

using namespace scifi;

namespace {

/// Helices of 120 to 280 MeV/c along z, starting within 50 mm.
struct crowd : test::helix_points {
  explicit crowd(int helices) {
    random_stream random(5, 0, 0);
    for (int i = 0; i < helices; ++i)
      add(random.uniform(-50.0, 50.0), random.uniform(-0.15, 0.15), random.uniform(-50.0, 50.0), random.uniform(-0.15, 0.15), (i % 2 == 0 ? 1.0 : -1.0) / random.uniform(120.0, 280.0));
    prepare();
  }
  bool search(double chi2_per_ndf) {
    search_trial trial{setting, points, work};
    return sure_search(trial)(chi2_per_ndf);
  }
  /// Helices of which all five points are a candidate.
  [[nodiscard]] std::size_t pure_ones() const {
    std::set<int> out;
    for (const candidate& c : work.found)
      if (pure(c)) out.insert(c.space_points[0] / 5);
    return out.size();
  }
};

}  // namespace

TEST_CASE("where points crowd, every track is among the candidates, whose chi2 is small in all", "[space_point_to_candidate]") {
  crowd c(16);
  REQUIRE(c.search(2.0));
  CHECK(c.pure_ones() == 16);
  for (const candidate& k : c.work.found) {
    CHECK(k.space_points.size() == 5);
    CHECK(k.chi2 <= 2.0 * 10.0);
    CHECK(k.ndf == 10);
  }
}

TEST_CASE("without a crowd nothing is searched", "[space_point_to_candidate]") {
  crowd few(10);
  few.setting.options.crowd = 1000;
  CHECK_FALSE(few.search(2.0));
  CHECK(few.work.found.empty());
  few.setting.options.crowd = 999;
  CHECK(few.search(2.0));
  CHECK(few.pure_ones() == 10);
  // Nor without a field.
  few.setting.options.field = 0.0;
  CHECK_FALSE(few.search(2.0));
}

TEST_CASE("a track with a point of two planes, two dim ones, or one of a bad crossing is not sure", "[space_point_to_candidate]") {
  crowd c(16);
  c.points[5].clusters.pop_back();
  c.points[11].chi2 = c.setting.options.tight_point_chi2 + 0.1;
  c.points[15].npe = c.points[18].npe = 1.0;
  c.points[21].npe = 1.0;  // one alone may be
  REQUIRE(c.search(2.0));
  CHECK(c.pure_ones() == 13);
  // Four points of chi2 6 are more than the 20 allowed.
  for (const std::size_t i : {35U, 36U, 37U, 38U}) c.points[i].chi2 = 6.0;
  REQUIRE(c.search(2.0));
  CHECK(c.pure_ones() == 12);
  REQUIRE(c.search(2.5));
  CHECK(c.pure_ones() == 13);
}

TEST_CASE("momenta far from what the prior has are left to later searches", "[space_point_to_candidate]") {
  crowd c(16);
  c.add(10.0, 0.2, -20.0, 0.1, 1.0 / 80.0);
  c.prepare();
  REQUIRE(c.search(2.0));
  CHECK(c.pure_ones() == 16);
}

TEST_CASE("the search in a crowd ends at its bounds", "[space_point_to_candidate]") {
  crowd c(16);
  search_trial trial{c.setting, c.points, c.work};
  trial.looks_left = 100;
  CHECK(sure_search(trial)(2.0));
  CHECK_FALSE(trial.complete());
  CHECK(trial.looks_left > -100);
}
