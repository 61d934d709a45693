// SPDX-License-Identifier: MPL-2.0
#include <scifi/io/event_view_json.hpp>

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>

#include "support/catch.hpp"

namespace {

constexpr double field = 3.0 * scifi::units::tesla;

scifi::event small_event() {
  scifi::event e;
  e.number = 7;
  e.digits = {{{0, 1, 2, 105}, 12.345}, {{1, 5, 0, 40}, 3.0}};
  e.clusters.resize(2);
  e.clusters[0].plane = 2;
  e.clusters[0].channel = 105.5;
  e.clusters[1].plane = 0;
  e.clusters[1].channel = 40.0;
  scifi::space_point p;
  p.position << 1.23456, -7.0;
  p.z = 0.5;
  p.npe = 20.0;
  p.clusters = {0, 1};
  e.space_points = {p};
  scifi::track t;
  t.tracker = 1;
  t.charge = -1;
  t.planes = 2;
  t.reference.mean << 1.0, 2.0, 30.0, -40.0, 200.0;
  t.reference.covariance.setZero();
  t.reference.covariance.diagonal() << 0.09, 0.16, 1.0, 4.0, 9.0;
  t.points = 2;
  scifi::track stopped = t;
  stopped.status.why = scifi::kalman::reason::not_finite;
  e.tracks = {stopped, t};
  e.track_points.resize(2);
  for (std::size_t i = 0; i < 2; ++i) {
    e.track_points[i].z = 200.0 * static_cast<double>(i);
    e.track_points[i].smoothed.mean << 1.0, 0.1, 2.0, 0.0, -0.005;
    e.track_points[i].residual = std::numeric_limits<double>::quiet_NaN();
    e.track_points[i].pull = std::numeric_limits<double>::quiet_NaN();
  }
  e.track_points[1].cluster = 1;
  e.track_points[1].residual = 0.25;
  e.track_points[1].pull = 0.5;
  return e;
}

}  // namespace

TEST_CASE("an event for a display: channels as lines, space points, tracks that the fit finished", "[io]") {
  const scifi::detector d = scifi::mice::trackers();
  const auto view = nlohmann::json::parse(scifi::event_view_json(d, small_event(), field).dump());
  CHECK(view["event"] == 7);
  REQUIRE(view["digits"].size() == 2);
  // Plane U of station 1: alpha = x = (105.5 - 105) * 1.4945 mm, along y.
  CHECK(std::abs(view["digits"][0]["from"][0].get<double>() - 0.747) < 1e-9);
  CHECK(std::abs(view["digits"][0]["to"][0].get<double>() - 0.747) < 1e-9);
  CHECK(std::abs(std::abs(view["digits"][0]["to"][1].get<double>()) - 159.998) < 1e-9);
  CHECK(view["digits"][0]["npe"] == 12.35);
  REQUIRE(view["space_points"].size() == 1);
  CHECK(view["space_points"][0]["at"] == nlohmann::json({1.235, -7.0, 0.5}));
  CHECK(view["space_points"][0]["channels"] == nlohmann::json::parse("[[2, 105.5], [0, 40.0]]"));
  REQUIRE(view["tracks"].size() == 1);
  const auto& t = view["tracks"][0];
  CHECK(t["track"] == 1);
  CHECK(t["pz"] == nlohmann::json({200.0, 3.0}));
  CHECK(t["points"][0]["channel"].is_null());
  CHECK(t["points"][0]["residual"].is_null());
  CHECK(t["points"][1]["channel"] == 40.0);
  CHECK(t["points"][1]["pull"] == 0.5);
  CHECK(t["curve"].size() > 2);
  CHECK_FALSE(view.contains("truth"));
}

TEST_CASE("the truth of an event is one line a particle and tracker", "[io]") {
  scifi::truth t;
  for (const int tracker : {0, 1})
    for (const double z : {0.0, 200.0}) t.crossings.push_back({3, -13, tracker, z > 0.0 ? 2 : 1, 0, {10.0, 0.0, z}, {0.0, 20.0, 200.0}});
  const auto view = scifi::event_view_json(scifi::mice::trackers(), {}, 0.0, &t);
  REQUIRE(view["truth"].size() == 2);
  CHECK(view["truth"][1]["tracker"] == 1);
  CHECK(view["truth"][1]["pdg"] == -13);
  CHECK(view["truth"][1]["points"].size() == 2);
  CHECK(view["truth"][1]["curve"].back() == nlohmann::ordered_json({10.0, 0.0, 200.0}));
}

TEST_CASE("the document names its format, the field in tesla and the detector", "[io]") {
  const auto document = scifi::event_view_document(scifi::mice::trackers(), field, "a run", nlohmann::ordered_json::array());
  CHECK(document["format"] == "scifi-event-view");
  CHECK(document["field"] == 3.0);
  REQUIRE(document["trackers"].size() == 2);
  CHECK(document["trackers"][0]["beam_direction"] == -1);
  CHECK(document["trackers"][0]["stations"].size() == 5);
  CHECK(document["trackers"][0]["stations"][4]["position"][2] == 1099.758);
  CHECK(document["trackers"][0]["stations"][4]["planes"][2]["view"] == "U");
}

TEST_CASE("digits of planes that do not exist have no line", "[io]") {
  scifi::event e;
  e.digits = {{{5, 1, 0, 3}, 1.0}};
  const auto view = scifi::event_view_json(scifi::mice::trackers(), e, field);
  CHECK_FALSE(view["digits"][0].contains("from"));
}
