// SPDX-License-Identifier: MPL-2.0
// scifi-align: shifts and rotations of stations or planes from the tracks through them; writes the corrected geometry.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <scifi/alignment/tracker_alignment.hpp>
#include <scifi/io/any_geometry.hpp>
#include <scifi/io/atomic_file.hpp>

#include "align/passes.hpp"
#include "align/report.hpp"
#include "field/chosen_flight.hpp"
#include "interruption.hpp"
#include "reconstruct/chains.hpp"
#include "reconstruct/command_line.hpp"
#include "run_program.hpp"

namespace {

namespace alignment = scifi::alignment;

struct options {
  reconstruction_input in;
  std::string output = "aligned.json", parameters;
  double min_p_value = 0.001;
  std::string level = "stations", free = "both", frame = "ends";
  std::vector<int> hold, trackers;
  int passes = 10, min_planes = 0;
};

void check(const options& o) {
  if (!(o.min_p_value >= 0.0 && o.min_p_value < 1.0)) throw std::invalid_argument("--min-p-value: not in 0 .. 1");
  std::error_code none;
  if (std::filesystem::exists(o.in.digits, none) && !std::filesystem::is_regular_file(o.in.digits, none))
    throw std::invalid_argument(o.in.digits + ": is not a file: the digits are read once for each pass");
}

void run(options& o) {
  static const std::map<std::string, alignment::frame> frames{{"ends", alignment::frame::ends}, {"average", alignment::frame::average}, {"none", alignment::frame::none}};
  interruption::listen();
  check(o);
  scifi::any_geometry geometry = o.in.prepare({o.output, o.parameters});
  const scifi::reconstruction_options choice = o.in.choice(geometry);
  const alignment::frame keep = frames.at(o.frame);
  const alignment::free_motions free{o.level == "planes" ? alignment::level::planes : alignment::level::stations, o.free != "rotations", o.free != "shifts", o.hold};
  for (const int id : o.trackers)
    if (geometry.detector.find(id) == nullptr) throw std::invalid_argument(fmt::format("--tracker: the geometry has no tracker {}", id));
  std::vector<aligned_tracker> trackers;
  for (const scifi::tracker& t : geometry.detector.trackers) {
    if (!o.trackers.empty() && std::find(o.trackers.begin(), o.trackers.end(), t.id) == o.trackers.end()) continue;
    alignment::track_cuts cuts;
    std::size_t planes = 0;
    for (const scifi::station& s : t.stations) planes += s.planes.size();
    cuts.min_planes = o.min_planes > 0 ? o.min_planes : static_cast<int>(std::ceil(0.8 * static_cast<double>(planes)));
    cuts.min_p_value = o.min_p_value;
    trackers.push_back({alignment::tracker_alignment(t, free, keep, cuts), {}, {}});
  }
  scifi::atomic_file aligned(o.output);
  std::optional<scifi::atomic_file> report;
  if (!o.parameters.empty()) report.emplace(o.parameters);

  with_flight(o.in.field, [&](const auto& flight_in) {
    align(o.in.digits, o.passes, o.in.threads, geometry.detector, [&](const scifi::detector& now) { return make_chain(now, choice, flight_in); }, trackers);
  });

  nlohmann::ordered_json results = nlohmann::ordered_json::array();
  for (const aligned_tracker& t : trackers) {
    for (scifi::tracker& into : geometry.detector.trackers)
      if (into.id == t.work.where().id) into = t.work.where();
    results.push_back(to_json(t, keep));
  }
  aligned.write(scifi::geometry_to_json(geometry).dump(2) + '\n');
  if (report) {
    const nlohmann::ordered_json document = {{"format", "scifi-alignment"},
                                             {"version", 1},
                                             {"digits", o.in.digits},
                                             {"geometry", o.in.geometry_name()},
                                             {"field", o.in.field.none() ? "none" : o.in.field.description()},
                                             {"level", o.level},
                                             {"free", o.free},
                                             {"frame", o.frame},
                                             {"held_stations", o.hold},
                                             {"trackers", std::move(results)}};
    report->write(document.dump(2) + '\n');
    report->commit();
  }
  aligned.commit();
  fmt::print("scifi-align: {}, {}\n", o.in.digits,
             o.in.field.none() ? fmt::format("straight tracks, scattering of {} MeV/c", o.in.momentum) : "bent tracks in " + o.in.field.description());
  for (const aligned_tracker& t : trackers) print(t);
  fmt::print("\nwritten {}{}\n", o.output, o.parameters.empty() ? "" : ", " + o.parameters);
}

}  // namespace

int main(int argc, char** argv) {
  options o;
  CLI::App app{"Aligns scintillating-fibre trackers with the tracks through them (Millepede's method). Units: mm, rad, MeV/c, tesla; tracker frame."};
  o.in.offer(app);
  app.get_option("--geometry")->description("geometry to start from, JSON (.json) or MiceModules (.dat); the MICE trackers unless given");
  app.get_option("--field")
      ->description("field in the tracker frame: a number, tesla along z (0: straight tracks); a file with a field map; or 'coils', those of the geometry")
      ->default_val("0");
  app.add_option("-o,--output", o.output, "geometry found, JSON")->capture_default_str();
  app.add_option("--parameters", o.parameters, "parameters with errors, covariance, constraints and modes, JSON; not written unless given");
  app.add_option("--tracker", o.trackers, "only these trackers; all unless given");
  app.add_option("--level", o.level, "what moves: stations or planes")->check(CLI::IsMember({"stations", "planes"}))->capture_default_str();
  app.add_option("--free", o.free, "how: shifts (stations: x and y; planes: along what they measure), rotations about z, or both")
      ->check(CLI::IsMember({"shifts", "rotations", "both"}))
      ->capture_default_str();
  app.add_option("--frame", o.frame, "what keeps the frame: ends (first and last station stay), average (mean and slope against z of all stations stay), none")
      ->check(CLI::IsMember({"ends", "average", "none"}))
      ->capture_default_str();
  app.add_option("--hold", o.hold, "stations that do not move at all, by their ids");
  app.add_option("--passes", o.passes, "at most so many passes over the digits; it ends when no parameter moves by more than a tenth of its error")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_option("--min-planes", o.min_planes, "least measurements of a track; 0: four fifths of the planes")->check(CLI::Range(0, 1000))->capture_default_str();
  app.add_option("--min-p-value", o.min_p_value, "least probability of a track's chi2, once the scale of all is known")->capture_default_str();
  return run_program("scifi-align", app, argc, argv, [&o] { run(o); });
}
