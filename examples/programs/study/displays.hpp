// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <scifi/event/event.hpp>
#include <scifi/event/truth.hpp>
#include <scifi/geometry/surface.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/study/true_track.hpp>
#include <scifi/track_model/conversions.hpp>
#include <scifi/track_model/helix_propagator.hpp>

namespace scifi::study_program {

using json = nlohmann::ordered_json;

/// A few events worth looking at, chosen while the events pass by: of each kind the best one so far is kept, drawn out as points.
class displays {
 public:
  using pairs = std::vector<std::pair<study::true_track, int>>;  ///< expected particles and the index of their track, or -1

  explicit displays(double field) : field_(field) {}

  void add(const tracker& where, std::span<const crossing> crossings, const event& e, const pairs& found) {
    const input in{where, crossings, e};
    constexpr double low_pt = 5.0;                             // MeV/c
    constexpr std::array<double, 2> usual_pt{30.0, 60.0};      // MeV/c
    constexpr double beyond_any = 1e9;
    double with_tracks = 0.0;
    for (const auto& [particle, index] : found) {
      if (index < 0) {
        consider(missed, 1.0 + particle.complete_stations, in);
        continue;
      }
      with_tracks += 1.0;
      const double p = e.tracks[static_cast<std::size_t>(index)].p_value;
      const double ordinary = 0.5 - std::abs(p - 0.5);
      if (found.size() == 1 && particle.pt() > usual_pt[0] && particle.pt() < usual_pt[1]) consider(typical, ordinary, in);
      if (found.size() == 1 && particle.pt() < low_pt) consider(straightest, ordinary, in);
      if (found.size() == 1 && particle.complete_stations == static_cast<int>(where.stations.size())) consider(worst_fit, beyond_any - p, in);
    }
    if (found.size() > 1 && with_tracks > 1.0) consider(most_tracks, with_tracks, in);
  }

  [[nodiscard]] json to_json() const {
    json out = json::array();
    for (const chosen& c : best_)
      if (!c.drawn.is_null()) out.push_back(c.drawn);
    return out;
  }

  /// The best of each kind, for another process.
  [[nodiscard]] json contents() const {
    json out = json::array();
    for (const chosen& c : best_) out.push_back({c.rank, c.drawn});
    return out;
  }
  /// Takes over what is better in what `contents` gave of other events; of equals the one of the earlier event, as if they had passed by in order.
  void add_contents(json others) {
    for (std::size_t k = 0; k < kinds; ++k) {
      chosen& mine = best_[k];
      json& drawn = others.at(k).at(1);
      if (drawn.is_null()) continue;
      const double rank = others.at(k).at(0).get<double>();
      if (mine.drawn.is_null() || rank > mine.rank || (rank == mine.rank && drawn.at("event").get<long>() < mine.drawn.at("event").get<long>())) mine = {rank, std::move(drawn)};
    }
  }

 private:
  enum kind : std::size_t { typical, straightest, most_tracks, worst_fit, missed, kinds };
  static constexpr std::array<const char*, kinds> titles{"a typical track", "a track of low transverse momentum", "the most tracks in one event",
                                                         "the track that fits worst", "a particle that was not found"};
  struct chosen {
    double rank = 0.0;
    json drawn;
  };

  struct input {
    const tracker& where;
    std::span<const crossing> crossings;
    const event& e;
  };

  void consider(kind k, double rank, const input& in) {
    if (rank > best_[k].rank) best_[k] = {rank, draw(titles[k], in)};
  }

  /// All particles that cross the reference surface, expected or not.
  [[nodiscard]] json draw(const char* title, const input& in) const {
    const auto& [where, crossings, e] = in;
    json out = {{"title", title}, {"event", e.number}, {"tracker", where.id}, {"name", where.name}, {"active_radius", where.active_radius}};
    out["particles"] = json::array();
    for (const study::true_track& particle : study::true_tracks(where, crossings)) {
      if (particle.reference() == nullptr) continue;
      json points = json::array();
      for (const crossing* c : particle.at)
        if (c != nullptr) points.push_back({c->position.z(), c->position.x(), c->position.y()});
      out["particles"].push_back({{"charge", particle.charge}, {"pt", particle.pt()}, {"pz", particle.reference()->momentum.z()}, {"crossings", std::move(points)}});
    }
    out["space_points"] = json::array();
    for (const space_point& p : e.space_points)
      if (p.tracker == where.id) out["space_points"].push_back({{"z", p.z}, {"x", p.position.x()}, {"y", p.position.y()}, {"clusters", p.clusters.size()}});
    out["tracks"] = json::array();
    for (const track& t : e.tracks)
      if (t.tracker == where.id && t.status.ok()) out["tracks"].push_back(draw(t, where, e));
    return out;
  }

  /// A track as a line through the tracker: helices from its points, or one from the reference surface where it has none.
  [[nodiscard]] json draw(const track& t, const tracker& where, const event& e) const {
    using m = momentum_state;
    using s = slope_state;
    const int travel = t.reference.mean[m::pz] > 0.0 ? 1 : -1;
    const vector<double, 5> start = momentum_to_slopes(t.reference.mean, t.charge).state;
    const auto points = std::span(e.track_points).subspan(static_cast<std::size_t>(t.first_point), static_cast<std::size_t>(t.points));
    const double field = t.shape == track_shape::line ? 0.0 : field_;
    const helix_propagator flight{field};
    const auto from = [&](const track_point& p, double z) { return flight.propagate<double>(p.smoothed.mean, z - p.z).state; };
    // Between two points a line that passes smoothly from the helix of one to that of the other: where the track scattered nobody knows.
    const auto state_at = [&](double z) -> vector<double, 5> {
      if (points.empty()) return flight.propagate<double>(start, z - t.z).state;
      const auto next = std::find_if(points.begin(), points.end(), [z](const track_point& p) { return p.z > z; });
      if (next == points.begin()) return from(*next, z);
      const auto last = next - 1;
      if (next == points.end()) return from(*last, z);
      const double share = (z - last->z) / (next->z - last->z);
      return (1.0 - share) * from(*last, z) + share * from(*next, z);
    };
    const std::vector<surface> planes = surfaces_along(where, +1);
    constexpr int pieces = 220;
    const double first = planes.front().z_reference;
    const double step = (planes.back().z - first) / pieces;
    json line = json::array();
    for (int i = 0; i <= pieces; ++i) {
      const double z = first + i * step;
      const vector<double, 5> here = state_at(z);
      line.push_back({z, here[s::x], here[s::y]});
    }
    json out = {{"charge", t.charge}, {"pt", std::hypot(t.reference.mean[m::px], t.reference.mean[m::py])}, {"pz", t.reference.mean[m::pz]}, {"travel", travel},
                {"chi2", t.chi2}, {"ndf", t.ndf}, {"p_value", t.p_value}, {"line", std::move(line)}};
    // x(z) turns about (x0 + ty/k, y0 - tx/k) with k = field q/pz.
    const double k = field * start[s::q_over_pz];
    if (k != 0.0) out["centre"] = {start[s::x] + start[s::ty] / k, start[s::y] - start[s::tx] / k};
    return out;
  }

  double field_;
  std::array<chosen, kinds> best_;
};

}  // namespace scifi::study_program
