// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <scifi/event/event.hpp>
#include <scifi/geometry/along_beam.hpp>
#include <scifi/geometry/channel_line.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/io/event_view_json.hpp>
#include <scifi/io/track_curve.hpp>
#include <scifi/track_model/helix_state.hpp>

namespace scifi {

/// Events for the Phoenix event display (HSF; its "event data format" of version 3): an object with an entry for each event, which has the collections
/// Tracks, Hits "Space points" (points) and Hits "Channels of view V", ... (lines). Lengths in mm, momenta in MeV/c, in the frame of the drawing that
/// `along_beam` makes of the trackers, for Phoenix knows one frame only. `field` is that of the fit, as in helix_propagator.
class phoenix_events {
 public:
  /// Distance in the drawing between one tracker and the next, mm.
  static constexpr double gap = 450.0;

  /// The detector must outlive it.
  phoenix_events(const detector& d, double field) : detector_(d), field_(field), places_(along_beam(d, gap)) {}

  /// Adds an event. Tracks whose fit stopped are left out, and so is what lies in a tracker or plane that the detector does not have.
  void add(const event& e) {
    nlohmann::ordered_json tracks = nlohmann::ordered_json::array();
    for (const track& t : e.tracks)
      if (const placed_along_beam* place = place_of(t.tracker); place != nullptr && t.status.ok()) tracks.push_back(track_to_phoenix(e, t, *place));
    nlohmann::ordered_json points = nlohmann::ordered_json::array();
    for (const space_point& p : e.space_points)
      if (const placed_along_beam* place = place_of(p.tracker))
        points.push_back({{"type", "Point"}, {"color", "0xE69F00"}, {"pos", position({p.position.x(), p.position.y(), p.z}, *place)}});
    nlohmann::ordered_json hits = nlohmann::ordered_json::object();
    if (!points.empty()) hits["Space points"] = std::move(points);
    for (const digit& d : e.digits) add_channel(d, hits);
    auto& out = events_["Event " + std::to_string(e.number)];
    out = {{"event number", e.number}, {"run number", 0}};
    out["Tracks"] = nlohmann::ordered_json::object();
    if (!tracks.empty()) out["Tracks"]["Fitted tracks"] = std::move(tracks);
    out["Hits"] = std::move(hits);
  }

  [[nodiscard]] const nlohmann::ordered_json& document() const { return events_; }

 private:
  [[nodiscard]] const placed_along_beam* place_of(int tracker) const {
    for (const placed_along_beam& p : places_)
      if (p.tracker == tracker) return &p;
    return nullptr;
  }
  [[nodiscard]] static nlohmann::ordered_json position(const vector<double, 3>& in_tracker, const placed_along_beam& place) {
    return detail::point_to_json(place.tracker_to_drawing(in_tracker));
  }

  [[nodiscard]] nlohmann::ordered_json track_to_phoenix(const event& e, const track& t, const placed_along_beam& place) const {
    using c = momentum_state;
    const auto& at = t.reference.mean;
    const std::span<const track_point> points(e.track_points.data() + t.first_point, static_cast<std::size_t>(t.points));
    nlohmann::ordered_json pos = nlohmann::ordered_json::array();
    for (const auto& p : track_curve(points, t.shape == track_shape::helix ? field_ : 0.0))
      if (p.allFinite()) pos.push_back(position(p, place));
    const double pt = std::hypot(at[c::px], at[c::py]);
    // Phoenix cuts on these; phi and eta are those of its own frame.
    const double pz = place.sense * at[c::pz];
    return {{"pos", std::move(pos)},
            {"color", t.charge < 0 ? "0x0072B2" : "0xD55E00"},
            {"chi2", detail::rounded(t.chi2, 1e3)},
            {"dof", t.ndf},
            {"charge", t.charge},
            {"pT", detail::rounded(pt, detail::per_momentum)},
            {"phi", detail::rounded(std::atan2(at[c::py], place.sense * at[c::px]), 1e6)},
            {"eta", detail::rounded(std::asinh(pz / pt), 1e6)},
            {"momentum", {detail::rounded(place.sense * at[c::px], detail::per_momentum), detail::rounded(at[c::py], detail::per_momentum),
                          detail::rounded(pz, detail::per_momentum)}}};
  }

  void add_channel(const digit& d, nlohmann::ordered_json& hits) const {
    const tracker* t = detector_.find(d.id.tracker);
    const plane* p = detector_.find_plane(d.id);
    const placed_along_beam* place = place_of(d.id.tracker);
    if (t == nullptr || p == nullptr || place == nullptr) return;
    for (const station& s : t->stations) {
      if (s.id != d.id.station) continue;
      const line_segment line = line_of_channel(s, *p, d.id.channel, t->active_radius);
      nlohmann::ordered_json pos = position(line.from, *place);
      for (const auto& x : position(line.to, *place)) pos.push_back(x);
      hits["Channels of view " + p->view].push_back({{"type", "Line"}, {"pos", std::move(pos)}, {"npe", detail::rounded(d.npe, detail::per_light)}});
    }
  }

  const detector& detector_;
  double field_;
  std::vector<placed_along_beam> places_;
  nlohmann::ordered_json events_ = nlohmann::ordered_json::object();
};

}  // namespace scifi
