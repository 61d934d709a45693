// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include <scifi/event/digit.hpp>

namespace scifi {

/// Appends a line that is one document of the JSON of the MICE experiment's software: a physics spill with one reconstructed event that has
/// digits and nothing made of them, which mice_json_reader reads back exactly. `spill` and `run` are its numbers, not negative. The digits have
/// no time: it is written as -10, the experiment's own mark for that. Throws std::invalid_argument where a number does not fit.
inline void append_mice_spill(std::string& out, long spill, std::span<const digit> digits, int run = 0) {
  constexpr double no_time = -10.0;  // ns
  if (spill < 0 || spill > std::numeric_limits<int>::max())
    throw std::invalid_argument("event " + std::to_string(spill) + " cannot be the number of a spill: that is 0 .. " +
                                std::to_string(std::numeric_limits<int>::max()));
  if (run < 0) throw std::invalid_argument("run " + std::to_string(run) + " is negative");
  using json = nlohmann::ordered_json;
  json found = json::array();
  for (const digit& d : digits)
    found.push_back({{"tracker", d.id.tracker},
                     {"station", d.id.station},
                     {"plane", d.id.plane},
                     {"channel", d.id.channel},
                     {"npe", d.npe},
                     {"time", no_time},
                     {"spill", spill},
                     {"event", 0},
                     {"used", false}});
  json content = {{"digits", std::move(found)}};
  for (const char* later : {"clusters", "spacepoints", "straight_pr_tracks", "helical_pr_tracks", "tracks"}) content[later] = json::array();
  json entry = {{"part_event_number", 0}, {"sci_fi_event", std::move(content)}};
  json document = {{"maus_event_type", "Spill"}, {"daq_event_type", "physics_event"}, {"run_number", run}, {"spill_number", spill}};
  document["errors"] = json::object();
  document["recon_events"] = json::array({std::move(entry)});
  out += document.dump();
  out += '\n';
}

}  // namespace scifi
