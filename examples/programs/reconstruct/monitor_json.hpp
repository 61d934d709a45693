// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <scifi/geometry/tracker.hpp>
#include <scifi/study/monitor_histograms.hpp>

/// Histograms of a monitor as a document for its page.
namespace monitor_json {

using json = nlohmann::ordered_json;
using scifi::study::counts;
using scifi::study::tracker_histograms;

[[nodiscard]] inline json contents(const counts& h) {
  const int bins = h.axis().size();
  json out = json::array();
  for (int i = 0; i < bins; ++i) out.push_back(h.at(i));
  return {{"counts", std::move(out)}, {"underflow", h.at(-1)}, {"overflow", h.at(bins)}};
}

[[nodiscard]] inline json axis(const counts& h) {
  return {{"label", h.axis().metadata()}, {"bins", h.axis().size()}, {"low", h.axis().value(0)}, {"high", h.axis().value(h.axis().size())}};
}

/// One plot: the same histogram of every tracker.
[[nodiscard]] inline json plot(const std::vector<tracker_histograms>& trackers, const char* name, const char* title, const char* per, counts tracker_histograms::*which) {
  json series = json::array();
  for (const tracker_histograms& t : trackers) {
    series.push_back(contents(t.*which));
    series.back()["tracker"] = t.tracker_number();
  }
  return {{"name", name}, {"title", title}, {"x", axis(trackers.front().*which)}, {"y", per}, {"series", std::move(series)}};
}

[[nodiscard]] inline json hit_maps(const tracker_histograms& t) {
  json planes = json::array();
  for (const scifi::study::plane_hits& p : t.planes)
    planes.push_back({{"station", p.station}, {"plane", p.plane}, {"view", p.view}, {"channels", p.channels.axis().size()}, {"hits", contents(p.channels)["counts"]}});
  return planes;
}

/// `status` is put in front: what the reconstruction has done so far. Trackers of the detector and of the histograms in the same order.
[[nodiscard]] inline json document(json status, const scifi::detector& d, const scifi::study::monitor_histograms& seen) {
  using h = tracker_histograms;
  json out = {{"format", "scifi-monitor"}, {"version", 1}, {"status", std::move(status)}};
  json trackers = json::array();
  for (std::size_t i = 0; i < d.trackers.size(); ++i)
    trackers.push_back({{"tracker", d.trackers[i].id}, {"name", d.trackers[i].name}, {"planes", hit_maps(seen.trackers()[i])}});
  out["trackers"] = std::move(trackers);
  json& plots = out["plots"] = json::array();
  if (d.trackers.empty()) return out;
  const auto& all = seen.trackers();
  plots.push_back(plot(all, "light", "Light of digits", "digits", &h::light));
  plots.push_back(plot(all, "channel_sums", "Channel sums (Kuno)", "space points", &h::channel_sums));
  plots.push_back(plot(all, "space_points", "Space points", "events", &h::space_points));
  plots.push_back(plot(all, "tracks", "Tracks", "events", &h::tracks));
  plots.push_back(plot(all, "residuals", "Residuals", "measurements", &h::residuals));
  plots.push_back(plot(all, "pulls", "Pulls", "measurements", &h::pulls));
  plots.push_back(plot(all, "p_values", "Goodness of fit", "tracks", &h::p_values));
  plots.push_back(plot(all, "pt", "Transverse momentum", "tracks", &h::pt));
  plots.push_back(plot(all, "pz", "Longitudinal momentum", "tracks", &h::pz));
  return out;
}

}  // namespace monitor_json
