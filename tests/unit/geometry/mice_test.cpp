// SPDX-License-Identifier: MPL-2.0
#include <scifi/geometry/mice.hpp>

#include <array>
#include <cmath>

#include <scifi/geometry/surface.hpp>

#include "support/catch.hpp"

namespace {

/// Centres of the stations in the frame of each tracker's solenoid (mm), from the geometry of the data taking of 2015 to 2017; z is
/// from the middle of the tracker.
constexpr std::array<std::array<std::array<double, 3>, 5>, 2> surveyed{{
    {{{0.0, 0.0, -549.8789}, {-0.5709, -0.7375, -349.9143}, {-1.2021, -0.1657, -100.0513}, {-0.5694, -0.6040, 199.9491}, {0.0, 0.0, 549.8789}}},
    {{{0.0, 0.0, -549.9513}, {-0.4698, 0.0052, -349.0577}, {-0.6717, -0.1759, -100.0523}, {0.1722, -0.2912, 199.8771}, {0.0, 0.0, 549.9513}}},
}};

}  // namespace

TEST_CASE("the stations of both trackers stand where the survey found them", "[geometry]") {
  const scifi::detector d = scifi::mice::trackers();
  REQUIRE(d.trackers.size() == 2);
  for (std::size_t t = 0; t < 2; ++t) {
    const scifi::tracker& tracker = d.trackers[t];
    CHECK(tracker.id == static_cast<int>(t));
    REQUIRE(tracker.stations.size() == 5);
    for (std::size_t s = 0; s < 5; ++s) {
      INFO("tracker " << t << " station " << s + 1);
      const scifi::station& station = tracker.stations[s];
      CHECK(station.id == static_cast<int>(s) + 1);
      CHECK(station.in_tracker.angle == 0.0);
      CHECK(station.in_tracker.origin.x() == Approx(surveyed[t][s][0]).margin(1e-9));
      CHECK(station.in_tracker.origin.y() == Approx(surveyed[t][s][1]).margin(1e-9));
      CHECK(station.in_tracker.origin.z() == Approx(surveyed[t][s][2] - surveyed[t][0][2]).margin(1e-9));
    }
  }
  CHECK(d.find(scifi::mice::upstream)->beam_direction == -1);
  CHECK(d.find(scifi::mice::upstream)->name == "TKU");
  CHECK(d.find(scifi::mice::downstream)->beam_direction == +1);
  CHECK(d.find(scifi::mice::downstream)->name == "TKD");
}

TEST_CASE("the stations are 200, 250, 300 and 350 mm apart but for the survey", "[geometry]") {
  // Ellis et al., NIM A 659 (2011) 136: unequal distances, so that a helix cannot turn by equal angles between all of them.
  const double nominal[] = {200.0, 250.0, 300.0, 350.0};
  for (const scifi::tracker& t : scifi::mice::trackers().trackers)
    for (std::size_t s = 0; s < 4; ++s)
      CHECK(std::abs(t.stations[s + 1].in_tracker.origin.z() - t.stations[s].in_tracker.origin.z() - nominal[s]) < 1.5);
}

TEST_CASE("each station has views V, W, U of 1498, 1498 and 1484 fibres whose channels sum to 318.5", "[geometry]") {
  const scifi::fibre_doublet fibre;
  for (const scifi::tracker& t : scifi::mice::trackers().trackers)
    for (const scifi::station& s : t.stations) {
      REQUIRE(s.planes.size() == 3);
      const char* views[] = {"V", "W", "U"};
      const int fibres[] = {1498, 1498, 1484};
      for (std::size_t p = 0; p < 3; ++p) {
        CHECK(s.planes[p].view == views[p]);
        CHECK(s.planes[p].channels * fibre.fibres_per_channel == fibres[p]);
        // The middle of the channels 0 .. n - 1 is alpha = 0.
        CHECK(s.planes[p].central_channel == 0.5 * (s.planes[p].channels - 1));
        CHECK(s.planes[p].channel_width == Approx(1.4945));
      }
      CHECK(s.channel_sum() == 318.5);
    }
}

TEST_CASE("the fibres of V, W and U run as in the experiment", "[geometry]") {
  // Directions of the fibres in the tracker frame; across them alpha grows along (dy, -dx).
  const double half = 0.5, root = std::sqrt(3.0) / 2.0;
  const scifi::vector<double, 3> along[] = {{-root, -half, 0.0}, {root, -half, 0.0}, {0.0, 1.0, 0.0}};
  const scifi::station s = scifi::mice::fibre_station(1, scifi::vector<double, 3>::Zero());
  for (std::size_t p = 0; p < 3; ++p) {
    const scifi::placement frame = s.planes[p].in_station();
    CHECK((frame.direction_child_to_parent({0.0, 1.0, 0.0}) - along[p]).norm() < 1e-15);
    const scifi::vector<double, 3> across(along[p].y(), -along[p].x(), 0.0);
    CHECK((frame.direction_child_to_parent({1.0, 0.0, 0.0}) - across).norm() < 1e-15);
  }
}

TEST_CASE("alphas of V, W and U at one point sum to zero in every surveyed station", "[geometry]") {
  for (const scifi::tracker& t : scifi::mice::trackers().trackers) {
    const auto surfaces = scifi::surfaces_along(t, +1);
    for (std::size_t i = 0; i < surfaces.size(); i += 3) {
      double sum = 0.0;
      for (std::size_t p = 0; p < 3; ++p) sum += surfaces[i + p].tracker_to_alpha(-41.3, 77.1);
      CHECK(std::abs(sum) < 1e-12);
    }
  }
}

TEST_CASE("planes of a station are 0.6523 mm apart and measure in the middle of their doublet", "[geometry]") {
  const scifi::station s = scifi::mice::fibre_station(1, scifi::vector<double, 3>::Zero());
  for (std::size_t p = 0; p < 3; ++p) {
    const scifi::plane& one = s.planes[p];
    CHECK(one.z_reference == Approx(0.6523 * static_cast<double>(p)).margin(1e-4));
    CHECK(one.z_measured - one.z_reference == Approx(0.025 + 0.5 * 0.6273).margin(1e-4));
    CHECK(scifi::thickness(one.below) == Approx(one.z_measured - one.z_reference).epsilon(1e-14));
    CHECK(scifi::thickness(one.above) == Approx(0.5 * 0.6273).margin(1e-4));
  }
}

TEST_CASE("a station is about half a per cent of a radiation length and one layer to every slab in it", "[geometry]") {
  const scifi::station s = scifi::mice::fibre_station(1, scifi::vector<double, 3>::Zero());
  double total = 0.0;
  for (const scifi::plane& p : s.planes) total += scifi::radiation_lengths(p.below) + scifi::radiation_lengths(p.above);
  // Radiation lengths 413.1 mm (polystyrene) and 285.4 mm (mylar).
  CHECK(total == Approx(3.0 * (0.62734 / 413.1 + 0.025 / 285.4)).epsilon(1e-3));
  CHECK(total == Approx(0.0049).margin(1e-4));
  for (const scifi::plane& p : s.planes) {
    REQUIRE(p.below.size() == 2);
    REQUIRE(p.above.size() == 1);
    CHECK(p.below[0].medium.name == "mylar");
    CHECK(p.below[1].medium.name == "polystyrene");
    for (const auto& stack : {p.below, p.above})
      for (const scifi::slab& one : stack) CHECK(one.layer_radiation_lengths == Approx(total).epsilon(1e-12));
  }
}

TEST_CASE("helium fills the trackers; efficiency is quoted to 150 mm and the fibres end at 160 mm", "[geometry]") {
  for (const scifi::tracker& t : scifi::mice::trackers().trackers) {
    CHECK(t.gas.name == "helium");
    CHECK(t.fiducial_radius == 150.0);
    CHECK(t.active_radius == 160.0);
  }
}
