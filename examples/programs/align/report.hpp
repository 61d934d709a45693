// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <scifi/alignment/frame_constraints.hpp>
#include <scifi/core/units.hpp>

#include "align/modes.hpp"
#include "align/passes.hpp"

/// chi2/ndf; zero without degrees of freedom.
[[nodiscard]] inline double per_ndf(double chi2, long ndf) { return ndf > 0 ? chi2 / static_cast<double>(ndf) : 0.0; }

/// What was found in a tracker, for other programs.
[[nodiscard]] inline nlohmann::ordered_json to_json(const aligned_tracker& t, scifi::alignment::frame keep) {
  namespace alignment = scifi::alignment;
  using nlohmann::ordered_json;
  const alignment::tracker_parameters& parameters = t.work.parameters();
  const alignment::solution& s = t.work.last();
  const std::vector<alignment::constraint> constraints = frame_constraints(parameters, keep);
  ordered_json out = {{"tracker", t.work.where().id}, {"passes", t.work.steps()}, {"settled", t.work.settled()}, {"tracks", t.last->equations.tracks()}};
  out["left_out"] = {{"too_few_planes", t.last->incomplete}, {"momentum_badly_known", t.last->unbent}, {"chi2", t.last->improbable}, {"failed", t.last->failed}};
  out["chi2_per_ndf"] = {{"before", per_ndf(t.first->equations.chi2(), t.first->equations.ndf())}, {"after", per_ndf(s.chi2, s.ndf)}};
  out["parameters"] = ordered_json::array();
  out["covariance"] = ordered_json::array();
  for (int i = 0; i < parameters.size(); ++i) {
    const alignment::tracker_parameter& p = parameters[i];
    ordered_json at = {{"station", p.station}};
    if (p.plane >= 0) at["plane"] = p.plane;
    at.update({{"motion", to_string(p.how)}, {"unit", p.unit()}, {"value", t.work.moved()[i]}, {"sigma", s.sigma(i)}});
    out["parameters"].push_back(std::move(at));
    ordered_json row = ordered_json::array();
    for (int j = 0; j < parameters.size(); ++j) row.push_back(s.covariance(i, j));
    out["covariance"].push_back(std::move(row));
  }
  out["constraints"] = ordered_json::array();
  for (std::size_t i = 0; i < constraints.size(); ++i)
    out["constraints"].push_back({{"name", constraints[i].name}, {"multiplier", s.multipliers[static_cast<Eigen::Index>(i)]}});
  out["modes"] = ordered_json::array();
  for (const alignment::mode& m : s.modes) out["modes"].push_back({{"share", m.share}, {"mainly", in_words(m, parameters)}});
  return out;
}

/// The same as a table for people.
inline void print(const aligned_tracker& t) {
  namespace alignment = scifi::alignment;
  const alignment::solution& s = t.work.last();
  fmt::print("\ntracker {}: {} tracks, {} passes{}, chi2/ndf {:.3f} -> {:.3f}\n", t.work.where().id, t.last->equations.tracks(), t.work.steps(),
             t.work.settled() ? "" : " (not settled: more --passes)", per_ndf(t.first->equations.chi2(), t.first->equations.ndf()), per_ndf(s.chi2, s.ndf));
  fmt::print("  left out: {} with too few planes, {} whose momentum is badly known, {} by chi2, {} failed\n", t.last->incomplete, t.last->unbent,
             t.last->improbable, t.last->failed);
  fmt::print("  {:<30}{:>12}{:>12}\n", "moved", "by", "sigma");
  for (int i = 0; i < t.work.parameters().size(); ++i) {
    const alignment::tracker_parameter& p = t.work.parameters()[i];
    const double unit = p.how == alignment::motion::rotation ? scifi::units::mrad : scifi::units::mm;
    fmt::print("  {:<30}{:>12.4f}{:>12.4f} {}\n", name_of(p), t.work.moved()[i] / unit, s.sigma(i) / unit, p.how == alignment::motion::rotation ? "mrad" : "mm");
  }
  if (!s.modes.empty())
    fmt::print("  weakest mode: {:.1f} times the error that it would have alone: {}\n", 1.0 / std::sqrt(s.modes.front().share),
               in_words(s.modes.front(), t.work.parameters()));
}
