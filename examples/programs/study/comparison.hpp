// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include <scifi/io/input_error.hpp>
#include <scifi/io/json_field.hpp>

namespace scifi::study_program {

using json = nlohmann::ordered_json;

inline constexpr const char* format_name = "scifi-study";
inline constexpr int format_version = 1;

/// The results of another study, as this program wrote them. Throws input_error for any other document.
[[nodiscard]] inline json read_study(const std::filesystem::path& path) {
  const nlohmann::json document = read_json(path);
  const json_field root(document, path.string());
  if (root.at("format").text() != format_name) root.at("format").fail("is not '" + std::string(format_name) + "'");
  if (root.at("version").number() != format_version) root.at("version").fail("is not " + std::to_string(format_version));
  if (!root.at("all").at("residuals").has("x")) root.at("all").at("residuals").fail("has no x: this study has no tracks");
  const json_field trackers = root.at("trackers");
  for (std::size_t i = 0; i < trackers.size(); ++i) (void)trackers.element(i).at("tracker").whole_number();
  return json(document);
}

/// A number inside a document by its pointer, or null.
[[nodiscard]] inline json number_at(const json& document, const std::string& pointer) {
  const json::json_pointer p(pointer);
  return document.contains(p) ? document.at(p) : json();
}

/// The table side by side: what was published, what is possible, what another study had, what this one has. Missing numbers are null.
///
/// Published: momentum resolution of the MICE trackers in their reconstruction's simulation study, muons at 3 T.
[[nodiscard]] inline json comparison(const json& all, const json& before) {
  json rows = json::array();
  const auto add = [&](const std::string& what, const json& unit, const json& published, const json& bound, const std::string& pointer) {
    const json now = number_at(all, pointer);
    if (now.is_null() || (now.is_number_float() && !std::isfinite(now.get<double>()))) return;  // straight tracks have no charge
    rows.push_back({{"what", what}, {"unit", unit}, {"published", published}, {"bound", bound}, {"before", before.is_null() ? json() : number_at(before, pointer)}, {"measured", now}});
  };
  constexpr double published_pt = 0.9;  // MeV/c
  constexpr double published_pz = 4.0;  // MeV/c
  for (const auto& [name, r] : all.at("residuals").items()) {
    const std::string at = "/residuals/" + name;
    const json published = name == "pt" ? json(published_pt) : name == "pz" ? json(published_pz) : json();
    add("spread of " + name, r.at("unit"), published, r.at("bound"), at + "/spread");
  }
  for (const auto& [name, r] : all.at("residuals").items()) {
    add("median of " + name, r.at("unit"), json(), 0, "/residuals/" + name + "/median");
    add("share of " + name + " beyond 5 spreads", "", json(), json(), "/residuals/" + name + "/beyond_5_spreads");
  }
  for (const auto& [name, r] : all.at("pulls").items()) add("spread of the pull of " + name, "", json(), 1, "/pulls/" + name + "/spread");
  for (const auto& [name, r] : all.at("pulls").items()) add("share of the pull of " + name + " beyond 5 spreads", "", json(), json(), "/pulls/" + name + "/beyond_5_spreads");
  add("chi2 per degree of freedom, mean", "", json(), 1, "/chi2_per_ndf/mean");
  add("p-value: Kolmogorov-Smirnov distance from flat", "", json(), json(), "/p_value/kolmogorov_smirnov_distance");
  add("efficiency", "", json(), 1, "/efficiency/value");
  add("ghosts per event", "", json(), 0, "/ghosts_per_event");
  add("ghosts per expected track", "", json(), 0, "/ghosts_per_expected");
  add("sign of the charge right", "", json(), 1, "/charge_correct/value");
  return rows;
}

}  // namespace scifi::study_program
