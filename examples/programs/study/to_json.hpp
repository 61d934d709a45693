// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <scifi/information/mixture_spread.hpp>
#include <scifi/study/channel_sums.hpp>
#include <scifi/study/distribution.hpp>
#include <scifi/study/track_study.hpp>

#include "study/tracker_results.hpp"

/// The results of a study as JSON. A number that does not exist (the median of nothing) is null. Sums run over sorted values: the order of events changes no bit.
namespace scifi::study_program {

using json = nlohmann::ordered_json;

[[nodiscard]] inline json to_json(const study::counts& h) {
  const auto& axis = h.axis();
  json values = json::array();
  for (int i = 0; i < axis.size(); ++i) values.push_back(h.at(i));
  return {{"label", axis.metadata()}, {"low", axis.bin(0).lower()}, {"high", axis.bin(axis.size() - 1).upper()},
          {"below", h.at(-1)},        {"counts", std::move(values)},  {"above", h.at(axis.size())}};
}

[[nodiscard]] inline json to_json(const study::sample& values) {
  const study::summary s = study::summarise(values);
  return {{"n", s.count},           {"mean", s.mean},     {"median", s.median}, {"median_error", s.median_error},
          {"spread", s.spread}, {"spread_error", s.spread_error}, {"beyond_5_spreads", s.tail}};
}

[[nodiscard]] inline json to_json(const study::distribution& d) {
  json out = to_json(d.values);
  out["histogram"] = to_json(d.histogram);
  return out;
}

[[nodiscard]] inline json to_json(const study::found_share& s) {
  const study::probability_interval i = s.interval();
  return {{"expected", s.expected}, {"found", s.found}, {"value", s.value()}, {"low", i.low}, {"high", i.high}};
}

template <class Cell, class Show>
[[nodiscard]] json row_to_json(const char* name, const study::momentum_row<Cell>& row, const Show& show) {
  json out = json::array();
  for (int i = 0; i < row.axis().size(); ++i) {
    json bin = {{name, {row.axis().bin(i).lower(), row.axis().bin(i).upper()}}};
    bin.update(show(row.at(i)));
    out.push_back(std::move(bin));
  }
  return out;
}

template <class Cell, class Show>
[[nodiscard]] json cells_to_json(const study::momentum_grid<Cell>& grid, const Show& show) {
  json cells = json::array();
  const auto& pt = grid.axis(0);
  const auto& pz = grid.axis(1);
  for (int i = 0; i < pt.size(); ++i) {
    for (int j = 0; j < pz.size(); ++j) {
      json bin = {{"pt", {pt.bin(i).lower(), pt.bin(i).upper()}}, {"pz", {pz.bin(j).lower(), pz.bin(j).upper()}}};
      bin.update(show(grid.at(i, j)));
      cells.push_back(std::move(bin));
    }
  }
  return cells;
}

/// Cells in pt and in pz of one grid, and in both of another (it may be the same).
template <class Cell, class Show>
[[nodiscard]] json grids_to_json(const study::momentum_grid<Cell>& single, const study::momentum_grid<Cell>& both, const Show& show) {
  return {{"by_pt", row_to_json("pt", study::in_pt(single), show)}, {"by_pz", row_to_json("pz", study::in_pz(single), show)}, {"by_pt_and_pz", cells_to_json(both, show)}};
}

/// One component of the momentum in one cell: residuals, what the fit states, the bound; all in the same kind of spread.
[[nodiscard]] inline json to_json(const study::momentum_samples& s) {
  const study::summary residual = study::summarise(s.residual);
  json out = to_json(s.residual);
  out["stated"] = mixture_spread(s.stated.sorted());
  out["bound"] = mixture_spread(s.bound.sorted());
  out["median_over_spread"] = residual.median / residual.spread;
  out["shifted"] = study::shift_rule{}(residual);
  out["shifted_by_chance"] = study::shift_rule{}.by_chance(residual);
  return out;
}

[[nodiscard]] inline json residuals_to_json(const study::state_residuals& r) {
  json out = json::object();
  for (std::size_t i = 0; i < study::residual_quantity::dimension; ++i) {
    const auto c = static_cast<study::residual_quantity::component>(i);
    if (r.residual(c).values.size() == 0) continue;
    json one = {{"unit", study::residual_quantity::units[i]}, {"bound", mixture_spread(r.bound(c).sorted())}};
    one.update(to_json(r.residual(c)));
    out[std::string(study::residual_quantity::names[i])] = std::move(one);
  }
  return out;
}

[[nodiscard]] inline json pulls_to_json(const study::state_residuals& r) {
  json out = json::object();
  for (const auto c : {momentum_state::x, momentum_state::y, momentum_state::px, momentum_state::py, momentum_state::pz})
    if (r.pull(c).values.size() > 0) out[std::string(momentum_state::names[c])] = to_json(r.pull(c));
  return out;
}

[[nodiscard]] inline json planes_to_json(const study::plane_pulls& planes) {
  json out = json::array();
  for (const study::pulls_at_plane& p : planes.planes()) {
    json one = {{"station", p.station}, {"plane", p.plane}, {"pulls", json::object()}};
    for (std::size_t k = 0; k < p.state.size(); ++k)
      if (p.state[k].values.size() > 0) one["pulls"][std::string(slope_state::names[k])] = to_json(p.state[k]);
    one["measurement_pull"] = to_json(p.measurement);
    one["measurement_residual_mm"] = to_json(p.residual);
    out.push_back(std::move(one));
  }
  return out;
}

/// Efficiency, ghosts, residuals and so on; `events` with truth, by which the ghosts are counted.
[[nodiscard]] inline json to_json(const study::track_study& t, long events) {
  json out;
  out["efficiency"] = to_json(t.found.all());
  out["tracks"] = t.tracks;
  out["ghosts"] = t.ghosts;
  out["duplicates"] = t.duplicates;
  out["ghosts_per_event"] = static_cast<double>(t.ghosts) / static_cast<double>(events);
  out["ghosts_per_expected"] = static_cast<double>(t.ghosts) / static_cast<double>(t.found.all().expected);
  out["efficiency_in_bins"] = grids_to_json(t.found.grid(), t.found.grid(), [](const study::found_share& s) { return to_json(s); });
  out["charge_correct"] = to_json(t.residuals.charge());
  out["residuals"] = residuals_to_json(t.residuals);
  out["pulls"] = pulls_to_json(t.residuals);
  out["chi2_per_ndf"] = to_json(t.goodness.chi2_per_ndf);
  out["p_value"] = to_json(t.goodness.p_value);
  const study::flatness flat = t.goodness.of_p_value();
  out["p_value"]["kolmogorov_smirnov_distance"] = flat.distance;
  out["p_value"]["kolmogorov_smirnov_probability"] = flat.probability;
  if (!out["residuals"].contains("pt")) return out;
  out["momentum_in_bins"] =
      grids_to_json(t.momentum.fine(), t.momentum.wide(), [](const study::momentum_cell& c) { return json{{"residual_pt", to_json(c.pt)}, {"residual_pz", to_json(c.pz)}}; });
  return out;
}

[[nodiscard]] inline json to_json(const study::occupancy& o) {
  return {{"digits_per_event", to_json(o.digits)},   {"clusters_per_event", to_json(o.clusters)}, {"space_points_per_event", to_json(o.space_points)},
          {"triplets_per_event", to_json(o.triplets)}, {"digit_npe", to_json(o.digit_light)},       {"cluster_npe", to_json(o.cluster_light)},
          {"cluster_size", to_json(o.cluster_size)}};
}

/// Sums of the channel numbers of triplets; a distribution is of sum - expected.
[[nodiscard]] inline json to_json(const study::channel_sums& sums) {
  json out = json::array();
  for (const study::station_channel_sums& s : sums.stations()) {
    json one = {{"station", s.station}, {"expected", s.expected}};
    one.update(to_json(s.difference));
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace scifi::study_program
