// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <span>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include <scifi/core/linalg.hpp>
#include <scifi/core/units.hpp>
#include <scifi/event/event.hpp>
#include <scifi/event/truth.hpp>
#include <scifi/geometry/channel_line.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/io/track_curve.hpp>
#include <scifi/kalman/estimate.hpp>
#include <scifi/material/particle.hpp>
#include <scifi/track_model/helix_state.hpp>
#include <scifi/track_model/slope_state.hpp>

namespace scifi {

/// What the document of an event display calls itself.
inline constexpr std::string_view event_view_format = "scifi-event-view";
inline constexpr int event_view_version = 1;

namespace detail {

/// Rounded to so many decimals: shorter in a file, and finer than a screen.
[[nodiscard]] inline double rounded(double x, double per_unit) { return std::round(x * per_unit) / per_unit; }
inline constexpr double per_mm = 1e3;
inline constexpr double per_momentum = 1e4;  // MeV/c
inline constexpr double per_light = 1e2;     // photo-electrons

[[nodiscard]] inline nlohmann::ordered_json point_to_json(const vector<double, 3>& p) {
  return {rounded(p.x(), per_mm), rounded(p.y(), per_mm), rounded(p.z(), per_mm)};
}

[[nodiscard]] inline nlohmann::ordered_json curve_to_json(std::span<const track_point> points, double field) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const auto& p : track_curve(points, field))
    if (p.allFinite()) out.push_back(point_to_json(p));
  return out;
}

[[nodiscard]] inline nlohmann::ordered_json digit_to_json(const detector& d, const digit& hit) {
  nlohmann::ordered_json out = {{"tracker", hit.id.tracker},
                                {"station", hit.id.station},
                                {"plane", hit.id.plane},
                                {"channel", hit.id.channel},
                                {"npe", rounded(hit.npe, per_light)}};
  const tracker* t = d.find(hit.id.tracker);
  const plane* p = d.find_plane(hit.id);
  if (t == nullptr || p == nullptr) return out;
  for (const station& s : t->stations) {
    if (s.id != hit.id.station) continue;
    const line_segment line = line_of_channel(s, *p, hit.id.channel, t->active_radius);
    out["from"] = point_to_json(line.from);
    out["to"] = point_to_json(line.to);
  }
  return out;
}

[[nodiscard]] inline nlohmann::ordered_json space_point_to_json(const event& e, const space_point& p) {
  nlohmann::ordered_json channels = nlohmann::ordered_json::array();
  for (const int i : p.clusters) {
    const cluster& c = e.clusters[static_cast<std::size_t>(i)];
    channels.push_back({c.plane, c.channel});
  }
  return {{"tracker", p.tracker},
          {"station", p.station},
          {"at", point_to_json({p.position.x(), p.position.y(), p.z})},
          {"npe", rounded(p.npe, per_light)},
          {"channels", std::move(channels)}};
}

[[nodiscard]] inline nlohmann::ordered_json track_to_json(const event& e, std::size_t number, double field) {
  using c = momentum_state;
  const track& t = e.tracks[number];
  const std::span<const track_point> points(e.track_points.data() + t.first_point, static_cast<std::size_t>(t.points));
  const auto value = [&](c::component i, double per_unit) -> nlohmann::ordered_json {
    return {rounded(t.reference.mean[i], per_unit), rounded(kalman::sigma(t.reference, i), per_unit)};
  };
  nlohmann::ordered_json out = {{"tracker", t.tracker},
                                {"track", number},
                                {"model", t.shape == track_shape::helix ? "helix" : "line"},
                                {"charge", t.charge},
                                {"stations", t.stations},
                                {"planes", t.planes},
                                {"chi2", rounded(t.chi2, 1e3)},
                                {"ndf", t.ndf},
                                {"p_value", rounded(t.p_value, 1e6)},
                                {"x", value(c::x, per_mm)},
                                {"y", value(c::y, per_mm)},
                                {"z", rounded(t.z, per_mm)},
                                {"px", value(c::px, per_momentum)},
                                {"py", value(c::py, per_momentum)},
                                {"pz", value(c::pz, per_momentum)}};
  nlohmann::ordered_json at = nlohmann::ordered_json::array();
  for (const track_point& p : points) {
    const auto* used = p.cluster >= 0 ? &e.clusters[static_cast<std::size_t>(p.cluster)] : nullptr;
    at.push_back({{"station", p.station},
                  {"plane", p.plane},
                  {"at", point_to_json({p.smoothed.mean[slope_state::x], p.smoothed.mean[slope_state::y], p.z})},
                  {"channel", used != nullptr ? nlohmann::ordered_json(used->channel) : nlohmann::ordered_json(nullptr)},
                  {"residual", rounded(p.residual, per_mm)},
                  {"pull", rounded(p.pull, 1e3)},
                  {"outlier", p.outlier}});
  }
  out["points"] = std::move(at);
  out["curve"] = curve_to_json(points, t.shape == track_shape::helix ? field : 0.0);
  return out;
}

/// The true particles of an event, one entry a particle and tracker: where they cross the planes, and a polyline to draw.
[[nodiscard]] inline nlohmann::ordered_json truth_to_json(const truth& t, double field) {
  std::map<std::array<int, 2>, std::vector<const crossing*>> flights;
  for (const crossing& c : t.crossings) flights[{c.tracker, c.particle}].push_back(&c);
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const auto& [of, crossings] : flights) {
    const auto species = particle_from_pdg(crossings.front()->pdg_id);
    const double charge = species ? species->charge : 0.0;
    std::vector<track_point> flight;
    nlohmann::ordered_json at = nlohmann::ordered_json::array();
    for (const crossing* c : crossings) {
      const auto& p = c->momentum;
      track_point& point = flight.emplace_back();
      point.z = c->position.z();
      point.smoothed.mean << c->position.x(), p.x() / p.z(), c->position.y(), p.y() / p.z(), charge / p.z();
      at.push_back({{"station", c->station}, {"plane", c->plane}, {"at", point_to_json(c->position)}});
    }
    const auto& first = crossings.front()->momentum;
    out.push_back({{"tracker", of[0]},
                   {"particle", of[1]},
                   {"pdg", crossings.front()->pdg_id},
                   {"p", {rounded(first.x(), per_momentum), rounded(first.y(), per_momentum), rounded(first.z(), per_momentum)}},
                   {"points", std::move(at)},
                   {"curve", curve_to_json(flight, field)}});
  }
  return out;
}

}  // namespace detail

/// What a display needs to know of a detector: radii, stations and planes in the frame of their tracker (mm, degree).
[[nodiscard]] inline nlohmann::ordered_json detector_view_json(const detector& d) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const tracker& t : d.trackers) {
    nlohmann::ordered_json stations = nlohmann::ordered_json::array();
    for (const station& s : t.stations) {
      nlohmann::ordered_json planes = nlohmann::ordered_json::array();
      for (const plane& p : s.planes) planes.push_back({{"view", p.view}, {"angle", detail::rounded(p.angle / units::degree, 1e6)}, {"z", p.z_measured}});
      stations.push_back({{"station", s.id}, {"position", detail::point_to_json(s.in_tracker.origin)}, {"planes", std::move(planes)}});
    }
    out.push_back({{"tracker", t.id},
                   {"name", t.name},
                   {"beam_direction", t.beam_direction},
                   {"active_radius", t.active_radius},
                   {"fiducial_radius", t.fiducial_radius},
                   {"stations", std::move(stations)}});
  }
  return out;
}

/// An event for a display: digits as lines in space, space points, fitted tracks with their points and a polyline to draw, and the truth where there is one.
/// Everything in the frame of its tracker, mm and MeV/c; a pair is a value and its standard deviation. `field` is that of the fit, as in helix_propagator.
/// Tracks whose fit stopped are left out. A number that is not finite becomes null.
[[nodiscard]] inline nlohmann::ordered_json event_view_json(const detector& d, const event& e, double field, const truth* true_event = nullptr) {
  nlohmann::ordered_json out = {{"event", e.number}};
  auto& digits = out["digits"] = nlohmann::ordered_json::array();
  for (const digit& hit : e.digits) digits.push_back(detail::digit_to_json(d, hit));
  auto& points = out["space_points"] = nlohmann::ordered_json::array();
  for (const space_point& p : e.space_points) points.push_back(detail::space_point_to_json(e, p));
  auto& tracks = out["tracks"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < e.tracks.size(); ++i)
    if (e.tracks[i].status.ok()) tracks.push_back(detail::track_to_json(e, i, field));
  if (true_event != nullptr) out["truth"] = detail::truth_to_json(*true_event, field);
  return out;
}

/// The whole document of a display: format and version, title, field (tesla), trackers, events.
[[nodiscard]] inline nlohmann::ordered_json event_view_document(const detector& d, double field, std::string_view title, nlohmann::ordered_json events) {
  return {{"format", event_view_format},
          {"version", event_view_version},
          {"title", title},
          {"field", detail::rounded(field / units::tesla, 1e9)},
          {"trackers", detector_view_json(d)},
          {"events", std::move(events)}};
}

}  // namespace scifi
