// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/phoenix_json.hpp>

#include <cmath>

#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"

namespace {

scifi::event event_in(int tracker) {
  scifi::event e;
  e.number = 3;
  e.digits = {{{tracker, 1, 0, 10}, 4.0}, {{tracker, 2, 2, 10}, 4.0}, {{9, 1, 0, 10}, 4.0}};
  scifi::space_point p;
  p.tracker = tracker;
  p.position << 5.0, 6.0;
  p.z = 100.0;
  e.space_points = {p};
  scifi::track t;
  t.tracker = tracker;
  t.charge = 1;
  t.chi2 = 8.0;
  t.ndf = 10;
  t.reference.mean << 1.0, 2.0, 30.0, 40.0, tracker == 0 ? -200.0 : 200.0;
  t.reference.covariance.setZero();
  t.points = 2;
  e.tracks = {t};
  e.track_points.resize(2);
  for (auto& at : e.track_points) at.smoothed.mean << 1.0, 0.15, 2.0, 0.2, 0.005;
  e.track_points[1].z = 500.0;
  return e;
}

}  // namespace

TEST_CASE("Phoenix gets tracks as polylines, space points as points and channels as lines, by view", "[io]") {
  const scifi::detector d = scifi::mice::trackers();
  scifi::phoenix_events out(d, 3.0 * scifi::units::tesla);
  out.add(event_in(1));
  const auto& e = out.document().at("Event 3");
  CHECK(e.at("event number") == 3);
  const auto& t = e.at("Tracks").at("Fitted tracks").at(0);
  CHECK(t.at("pos").size() > 2);
  CHECK(t.at("dof") == 10);
  CHECK(t.at("pT") == 50.0);
  CHECK(std::abs(t.at("eta").get<double>() - std::asinh(4.0)) < 1e-6);
  CHECK(e.at("Hits").at("Space points").at(0).at("pos").size() == 3);
  CHECK(e.at("Hits").at("Channels of view V").size() == 1);
  CHECK(e.at("Hits").at("Channels of view U").at(0).at("pos").size() == 6);
  CHECK_FALSE(e.at("Hits").contains("Channels of view W"));
}

TEST_CASE("in Phoenix the beam travels towards +z in both trackers", "[io]") {
  const scifi::detector d = scifi::mice::trackers();
  scifi::phoenix_events out(d, 3.0 * scifi::units::tesla);
  out.add(event_in(0));
  const auto& t = out.document().at("Event 3").at("Tracks").at("Fitted tracks").at(0);
  CHECK(t.at("momentum").at(2) == 200.0);
  CHECK(t.at("momentum").at(0) == -30.0);
  CHECK(t.at("eta").get<double>() > 0.0);
  CHECK(std::abs(t.at("phi").get<double>() - std::atan2(40.0, -30.0)) < 1e-6);
}

TEST_CASE("an event without anything is still an event", "[io]") {
  const scifi::detector d = scifi::mice::trackers();
  scifi::phoenix_events out(d, 0.0);
  out.add({});
  CHECK(out.document().at("Event 0").at("Tracks").is_object());
  CHECK(out.document().at("Event 0").at("Hits").empty());
}
