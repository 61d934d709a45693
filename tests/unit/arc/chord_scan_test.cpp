// SPDX-License-Identifier: MPL-2.0
#include <scifi/arc/chord_scan.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <scifi/core/random.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

constexpr double step1 = 200.0, step2 = 250.0, most = 0.009;
constexpr double variance = 0.9;
constexpr chord_scan::scatter matter{1.0 / (0.9 * 0.9), 2.25e-6, 5e4, 5.6e8};

struct chord {
  planar<double> c;
  double cost;
};

/// The same in double precision, with the library's functions.
struct expectation {
  double w, chi2;
};
expectation plainly(const planar<double>& first, const planar<double>& second) {
  const planar<double> product = conjugate(first) * second;
  const double w = -std::atan2(product.y, product.x) / (0.5 * (step1 + step2));
  const double ratio = w == 0.0 ? step2 / step1 : std::sin(0.5 * w * step2) / std::sin(0.5 * w * step1);
  const double k2 = std::max(w * w * matter.per_field2, matter.least);
  return {w, square(std::hypot(second.x, second.y) - ratio * std::hypot(first.x, first.y)) / (variance + k2 * (matter.a + matter.b * k2))};
}

}  // namespace

TEST_CASE("a scan finds the third points that the angle and the lengths of the chords allow, many at once as one by one", "[arc]") {
  random_stream random(1, 0, 0);
  chord_scan scan;
  scan.prepare(chord_turn(step1, step2, 0.018), most, matter);
  constexpr double limit = 12.0;
  long hits = 0, close = 0;
  for (int k = 0; k < 200; ++k) {
    std::vector<chord> chords;
    scan.clear();
    for (int i = 0; i < k; ++i) {
      chords.push_back({{random.uniform(-100.0, 100.0), random.uniform(-100.0, 100.0)}, random.uniform(0.0, 9.0)});
      scan.add(chords.back().c, chords.back().cost, 7 * i);
    }
    scan.order();
    const planar<double> first{random.uniform(-60.0, 60.0), random.uniform(-60.0, 60.0)};
    std::map<int, chord_scan::hit> found;
    for (const chord_scan::hit& h : scan(first, variance, limit)) CHECK(found.emplace(h.point, h).second);
    for (int i = 0; i < k; ++i) {
      const chord& c = chords[static_cast<std::size_t>(i)];
      const expectation e = plainly(first, c.c);
      const auto h = found.find(7 * i);
      if (h != found.end()) {
        ++hits;
        CHECK(h->second.curvature == Approx(e.w).margin(2e-5 / 225.0));
        CHECK(h->second.chi2 == Approx(e.chi2).epsilon(2e-2).margin(2e-2));
      }
      // Single precision and the table decide otherwise only where it is close.
      if (std::abs(e.chi2 + c.cost - limit) < 0.3 || std::abs(std::abs(e.w) - most) < 1e-6) ++close;
      else CHECK((h != found.end()) == (std::abs(e.w) < most && e.chi2 + c.cost < limit));
    }
  }
  CHECK(hits > 300);
  CHECK(close < hits / 3);
}

TEST_CASE("where no chord fits, or none is there, a scan finds none", "[arc]") {
  chord_scan scan;
  scan.prepare(chord_turn(step1, step2, 0.018), most, matter);
  scan.clear();
  scan.order();
  CHECK(scan({30.0, 0.0}, variance, 12.0).empty());
  scan.add({-37.0, 0.0}, 0.0, 1);   // turned back
  scan.add({90.0, 0.0}, 0.0, 2);    // too long
  scan.add({37.5, 0.0}, 13.0, 3);   // its own chi2 is too large
  scan.order();
  CHECK(scan({30.0, 0.0}, variance, 12.0).empty());
  CHECK(scan({30.0, 0.0}, variance, -1.0).empty());
  scan.add({37.5, 0.0}, 1.0, 4);
  scan.order();
  const auto hits = scan({30.0, 0.0}, variance, 12.0);
  REQUIRE(hits.size() == 1);
  CHECK(hits[0].point == 4);
  CHECK(scan.rounds() == 1);
  CHECK(hits[0].curvature == Approx(0.0).margin(1e-7));
}
