// SPDX-License-Identifier: MPL-2.0
#include <scifi/study/monitor_histograms.hpp>

#include <cmath>
#include <cstddef>
#include <limits>

#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"

namespace {

namespace study = scifi::study;

scifi::event event_of_tracker_1() {
  scifi::event e;
  e.digits = {{{0, 1, 0, 3}, 5.0}, {{1, 2, 0, 0}, 7.25}, {{1, 2, 0, 213}, 99.0}, {{1, 2, 2, 100}, 7.0}, {{1, 9, 0, 3}, 7.0}};
  e.clusters.resize(3);
  e.clusters[0].channel = 100.0;
  e.clusters[1].channel = 110.5;
  e.clusters[2].channel = 109.5;
  scifi::space_point p;
  p.tracker = 1;
  p.station = 2;
  p.clusters = {0, 1, 2};
  scifi::space_point doublet = p;
  doublet.clusters = {0, 1};
  e.space_points = {p, doublet};
  scifi::track t;
  t.tracker = 1;
  t.ndf = 10;
  t.p_value = 0.33;
  t.reference.mean << 0.0, 0.0, 30.0, 40.0, -201.0;
  t.reference.covariance.setZero();
  t.points = 2;
  scifi::track line = t;
  line.shape = scifi::track_shape::line;
  line.points = 0;
  scifi::track stopped = t;
  stopped.status.why = scifi::kalman::reason::not_finite;
  e.tracks = {t, line, stopped};
  e.track_points.resize(2);
  e.track_points[0].residual = 0.51;
  e.track_points[0].pull = -1.05;
  e.track_points[1].residual = e.track_points[1].pull = std::numeric_limits<double>::quiet_NaN();
  return e;
}

double total(const study::counts& h) {
  double sum = 0.0;
  for (const double n : h) sum += n;
  return sum;
}
double at(const study::counts& h, double x) { return h.at(h.axis().index(x)); }

}  // namespace

TEST_CASE("an event is counted where it belongs, tracker by tracker", "[study]") {
  study::monitor_histograms watch(scifi::mice::trackers());
  watch.add(event_of_tracker_1());
  CHECK(watch.events() == 1);
  const auto& other = watch.trackers()[0];
  CHECK(at(other.space_points, 0.0) == 1.0);
  CHECK(at(other.planes[0].channels, 3.0) == 1.0);
  CHECK(total(other.residuals) == 0.0);

  const auto& t = watch.trackers()[1];
  REQUIRE(t.planes.size() == 15);
  CHECK(t.planes[3].station == 2);
  CHECK(at(t.planes[3].channels, 0.0) == 1.0);
  CHECK(at(t.planes[3].channels, 213.0) == 1.0);
  CHECK(t.planes[5].view == "U");
  CHECK(at(t.planes[5].channels, 100.0) == 1.0);
  CHECK(at(t.light, 7.25) == 3.0);  // 7 and 7.25 share a bin of half a photo-electron
  CHECK(t.light.at(t.light.axis().size()) == 1.0);
  // 100 + 110.5 + 109.5 - (106.5 + 106.5 + 105.5) = 1.5; the doublet says nothing.
  CHECK(at(t.channel_sums, 1.5) == 1.0);
  CHECK(total(t.channel_sums) == 1.0);
  CHECK(at(t.space_points, 2.0) == 1.0);
  CHECK(at(t.tracks, 2.0) == 1.0);
  CHECK(at(t.p_values, 0.33) == 2.0);
  CHECK(at(t.pt, 50.5) == 1.0);
  CHECK(at(t.pz, 201.0) == 1.0);
  CHECK(total(t.pz) == 1.0);
  CHECK(at(t.residuals, 0.51) == 1.0);
  CHECK(at(t.pulls, -1.05) == 1.0);
  CHECK(total(t.residuals) == 1.0);
}

TEST_CASE("histograms filled apart and merged are those filled together; cleared ones are empty", "[study]") {
  const scifi::detector d = scifi::mice::trackers();
  study::monitor_histograms together(d), sum(d), part(d);
  for (int block = 0; block < 3; ++block) {
    part.clear();
    for (int i = 0; i < 2; ++i) {
      together.add(event_of_tracker_1());
      part.add(event_of_tracker_1());
    }
    sum += part;
  }
  CHECK(sum.events() == 6);
  for (std::size_t k = 0; k < 2; ++k) {
    auto mine = sum.trackers()[k];
    mine.each([](const study::counts& a, const study::counts& b) { CHECK(a == b); }, together.trackers()[k]);
  }
  sum.clear();
  CHECK(sum.events() == 0);
  auto emptied = sum.trackers()[1];
  emptied.each([](const study::counts& h) { CHECK(total(h) == 0.0); });
}

TEST_CASE("histograms that came from another process as numbers are those histograms", "[study]") {
  const scifi::detector d = scifi::mice::trackers();
  study::monitor_histograms there(d), here(d);
  there.add(event_of_tracker_1());
  here.add(event_of_tracker_1());
  REQUIRE(here.add_contents(there.contents()));
  there.add(event_of_tracker_1());
  CHECK(here.contents() == there.contents());
  CHECK(here.events() == 2);
  std::vector<double> other = there.contents();
  other.pop_back();
  CHECK_FALSE(here.add_contents(other));
  CHECK(here.events() == 2);
}
