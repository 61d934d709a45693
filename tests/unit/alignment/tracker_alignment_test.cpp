// SPDX-License-Identifier: MPL-2.0
#include <scifi/alignment/tracker_alignment.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

#include "simulated_tracks.hpp"
#include "support/catch.hpp"

using namespace scifi;
using namespace scifi::alignment;

namespace {

/// Stations 2, 3 and 4 away from where they are believed.
tracker displaced(tracker t) {
  const std::vector<vector<double, 3>> by{{0.5, -0.5, 0.005}, {-0.5, -0.5, -0.005}, {0.5, 0.5, 0.005}};
  for (std::size_t i = 0; i < by.size(); ++i) {
    placement& p = t.stations[i + 1].in_tracker;
    p.origin.x() += by[i].x();
    p.origin.y() += by[i].y();
    p.angle += by[i].z();
  }
  return t;
}

tracker_alignment align(const detector& believed, std::vector<event> events, double field, const free_motions& free, frame keep) {
  tracker_alignment out(believed.trackers.front(), free, keep, {});
  for (int i = 0; i < 6 && !out.settled(); ++i) {
    const auto chain = make_reconstruction({{out.where()}}, {.field = field, .fibre = {}});
    const track_collector<test::standard_fitter> collect(out.parameters(), chain.trackers().front().fit_track, out.cuts());
    track_collector<test::standard_fitter>::buffers work;
    tracker_sum sum = collect.empty();
    for (event& e : events) {
      test::reconstruct(chain, e);
      collect(e, sum, work);
    }
    out.step(sum);
    REQUIRE(out.last().status == failure::none);
  }
  return out;
}

/// Tracks neither scatter nor slow, so all that errs is the width of a channel, and the errors stated are too large: most are within one, all within three.
void check_recovered(int id, double field) {
  const detector believed = test::one_tracker(id);
  const tracker real = displaced(believed.trackers.front());
  const tracker_alignment found = align(believed, test::crossing_tracks(real, field, 200, 21), field, {}, frame::ends);
  CHECK(found.settled());
  for (std::size_t s = 0; s < real.stations.size(); ++s) {
    const placement& truth = real.stations[s].in_tracker;
    const placement& now = found.where().stations[s].in_tracker;
    const placement& before = believed.trackers.front().stations[s].in_tracker;
    const auto check = [&](motion how, double difference, double moved) {
      const int i = found.parameters().find(static_cast<int>(s) + 1, -1, how);
      INFO(name_of(found.parameters()[i]));
      CHECK(std::abs(difference) <= 3.0 * found.last().sigma(i) + 1e-9);
      CHECK(found.moved()[i] == Approx(moved).margin(1e-12));
    };
    check(motion::x, now.origin.x() - truth.origin.x(), now.origin.x() - before.origin.x());
    check(motion::y, now.origin.y() - truth.origin.y(), now.origin.y() - before.origin.y());
    check(motion::rotation, now.angle - truth.angle, now.angle - before.angle);
  }
}

}  // namespace

TEST_CASE("displaced stations are found with straight tracks", "[alignment]") { check_recovered(mice::downstream, 0.0); }

TEST_CASE("displaced stations are found with helices, against the beam's direction in z too", "[alignment]") { check_recovered(mice::upstream, 3.0 * units::tesla); }

TEST_CASE("a displaced plane is found among the planes", "[alignment]") {
  const detector believed = test::one_tracker(mice::downstream);
  tracker real = believed.trackers.front();
  plane& moved = real.stations[2].planes[1];
  moved.central_channel += 0.5 / moved.channel_width;
  moved.angle += 0.005;
  const tracker_alignment found = align(believed, test::crossing_tracks(real, 0.0, 200, 22), 0.0, {level::planes, true, true, {1, 5}}, frame::none);
  for (int i = 0; i < found.parameters().size(); ++i) {
    const tracker_parameter& p = found.parameters()[i];
    const bool it = p.station == 3 && p.plane == 1;
    const double truth = it ? (p.how == motion::rotation ? 0.005 : 0.5) : 0.0;
    INFO(name_of(p));
    CHECK(std::abs(found.moved()[i] - truth) <= 3.0 * found.last().sigma(i));
  }
}

TEST_CASE("without tracks nothing moves and the status says why", "[alignment]") {
  const detector believed = test::one_tracker(mice::downstream);
  tracker_alignment a(believed.trackers.front(), {}, frame::ends, {});
  a.step(tracker_sum(a.parameters().size()));
  CHECK(a.last().status == failure::undetermined_parameters);
  CHECK(a.moved().norm() == 0.0);
  CHECK(a.steps() == 0);
  CHECK_FALSE(a.settled());
}
