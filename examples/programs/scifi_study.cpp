// SPDX-License-Identifier: MPL-2.0
// scifi-study: how well tracks were reconstructed, beside the truth and the Cramer-Rao bound: every number in JSON, pictures and a page.
#include <algorithm>
#include <cmath>
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

#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/io/any_geometry.hpp>
#include <scifi/io/atomic_file.hpp>
#include <scifi/version.hpp>

#include "interruption.hpp"
#include "ranks.hpp"
#include "run_program.hpp"
#include "study/comparison.hpp"
#include "study/displays.hpp"
#include "study/gather.hpp"
#include "study/page.hpp"
#include "study/study_input.hpp"
#include "study/to_json.hpp"
#include "study/tracker_results.hpp"

namespace {

namespace fs = std::filesystem;
namespace study = scifi::study;
using scifi::study_program::json;
using scifi::study_program::tracker_results;

struct options {
  std::string truth, tracks, points, digits, geometry, before, output, python;
  std::optional<double> given_field;  // tesla
  double field = 3.0, min_npe = 2.0;
  bool no_page = false;
  study::study_options study;
};

void check(const options& o) {
  const auto require = [](bool good, const char* what) {
    if (!good) throw std::invalid_argument(what);
  };
  require(std::isfinite(o.given_field.value_or(0.0)), "--field: not a finite number");
  require(std::isfinite(o.min_npe) && o.min_npe >= 0.0, "--min-npe: not a finite number from 0 on");
  require(o.study.expected.min_stations >= 1, "--min-stations: not a number from 1 on");
  require(o.study.expected.max_pt_over_pz > 0.0, "--max-pt-over-pz: not a number above 0");
  const auto rise = [](const std::vector<double>& edges) {
    for (std::size_t i = 0; i < edges.size(); ++i)
      if (!std::isfinite(edges[i]) || (i > 0 && !(edges[i] > edges[i - 1]))) return false;
    return edges.size() > 1;
  };
  require(rise(o.study.edges.pt), "--pt-edges: not two or more rising numbers");
  require(rise(o.study.edges.pz), "--pz-edges: not two or more rising numbers");
  require(rise(o.study.wide_edges.pt), "--wide-pt-edges: not two or more rising numbers");
  require(rise(o.study.wide_edges.pz), "--wide-pz-edges: not two or more rising numbers");
}

/// What is known of a tracker, and whether it has anything at all.
struct one_tracker {
  tracker_results results;
  long used = 0;  ///< events with something

  template <class Visit>
  void each(const Visit& visit) {
    visit(results);
    visit(used);
  }
};

struct whole_study {
  std::map<int, one_tracker> trackers;
  long events = 0;          // with truth
  long without_truth = 0;   // events with tracks or digits, but no truth
  scifi::study_program::displays shown;

  template <class Visit>
  void each(const Visit& visit) {
    for (auto& [id, t] : trackers) visit(t);
    visit(events);
    visit(without_truth);
  }
};

/// Every rank reads all files and studies each n-th event; the first one gets the study of all.
whole_study fill(const options& o, const ranks& all, const scifi::detector& detector, const scifi::fibre_doublet& fibre) {
  scifi::study_program::study_input input(detector, o.truth, o.tracks, o.points, o.digits);
  scifi::study_program::front_half front(detector, o.min_npe, fibre);
  whole_study out{.trackers = {}, .shown = scifi::study_program::displays(o.study.field)};
  for (const scifi::tracker& t : detector.trackers) out.trackers.emplace(t.id, one_tracker{tracker_results(t, o.study)});
  scifi::study_program::event_files e;
  for (long i = 0; input.next(e); ++i) {
    interruption::throw_if_received();
    if (i % all.size() != all.rank()) continue;
    e.crossings.empty() ? ++out.without_truth : ++out.events;
    if (!o.digits.empty()) front(e.seen);
    for (const scifi::tracker& t : detector.trackers) {
      one_tracker& here = out.trackers.at(t.id);
      const auto mine = [&t](const auto& one) { return one.tracker == t.id; };
      here.used += std::any_of(e.crossings.begin(), e.crossings.end(), mine) || std::any_of(e.seen.tracks.begin(), e.seen.tracks.end(), mine) ? 1 : 0;
      const auto pairs = here.results.tracks.add(e.crossings, e.seen);
      out.shown.add(t, e.crossings, e.seen, pairs);
      if (o.digits.empty()) continue;
      here.results.seen.add(e.seen, t.id);
      here.results.sums.add(e.seen.clusters);
    }
  }
  return out;
}

json to_json(const options& o, const whole_study& s, const json& before) {
  using scifi::study_program::to_json;
  const auto with_digits = [&](json block, const tracker_results& r) {
    if (o.digits.empty()) return block;
    block["digits"] = to_json(r.seen);
    return block;
  };
  json out = {{"format", scifi::study_program::format_name}, {"version", scifi::study_program::format_version}, {"program", std::string(scifi::version)}};
  const auto name = [](const std::string& path) { return path.empty() ? json() : json(fs::path(path).filename().string()); };
  out["input"] = {{"truth", name(o.truth)}, {"tracks", name(o.tracks)}, {"track_points", name(o.points)}, {"digits", name(o.digits)}, {"geometry", name(o.geometry)},
                  {"before", name(o.before)}, {"field_tesla", o.field}, {"min_npe", o.min_npe}};
  const study::expectation& e = o.study.expected;
  out["definitions"] = {{"min_stations", e.min_stations}, {"max_pt_over_pz", e.max_pt_over_pz}, {"match_mm", o.study.window.position},
                        {"match_MeV", o.study.window.momentum}, {"shift_share_of_spread", study::shift_rule{}.share_of_spread},
                        {"shift_more_tracks_than", study::shift_rule{}.more_tracks_than}, {"pt_edges", o.study.edges.pt}, {"pz_edges", o.study.edges.pz},
                        {"wide_pt_edges", o.study.wide_edges.pt}, {"wide_pz_edges", o.study.wide_edges.pz}};
  out["events"] = s.events;
  out["events_without_truth"] = s.without_truth;
  out["trackers"] = json::array();
  std::optional<tracker_results> all;
  for (const auto& [id, t] : s.trackers) {
    if (t.used == 0) continue;
    const scifi::tracker& where = t.results.tracks.where();
    json block = {{"tracker", id}, {"name", where.name}, {"fiducial_radius", where.fiducial_radius}};
    block.update(with_digits(to_json(t.results.tracks, s.events), t.results));
    if (!o.digits.empty()) block["channel_sums"] = to_json(t.results.sums);
    if (!o.points.empty()) block["planes"] = scifi::study_program::planes_to_json(t.results.tracks.planes);
    out["trackers"].push_back(std::move(block));
    if (all) *all += t.results;
    else all = t.results;
  }
  if (!all) throw std::invalid_argument("no tracker of the geometry has a particle or a track");
  out["all"] = with_digits(to_json(all->tracks, s.events), *all);
  if (!before.is_null()) {
    out["before"] = {{"input", before.value("input", json())}, {"all", before.at("all")}, {"trackers", json::array()}};
    for (const json& t : before.at("trackers"))
      if (t.contains("planes")) out["before"]["trackers"].push_back({{"tracker", t.at("tracker")}, {"planes", t.at("planes")}});
  }
  out["comparison"] = scifi::study_program::comparison(out["all"], before.is_null() ? json() : before.at("all"));
  out["displays"] = s.shown.to_json();
  return out;
}

void print_summary(const json& result, const fs::path& folder, bool drawn) {
  const auto value = [](const json& v) { return v.is_number() ? fmt::format("{:.4g}", v.get<double>()) : std::string("-"); };
  const json& all = result.at("all");
  fmt::print("scifi-study {}   units: mm, MeV/c, tesla\n", scifi::version);
  fmt::print("{} events, {} particles expected, {} found, {} ghosts, {} of them duplicates\n\n", result.at("events").get<long>(),
             all.at("efficiency").at("expected").get<long>(), all.at("efficiency").at("found").get<long>(), all.at("ghosts").get<long>(), all.at("duplicates").get<long>());
  fmt::print("{:<50}{:>8}{:>11}{:>11}{:>11}{:>11}\n", "", "unit", "published", "bound", "before", "measured");
  for (const json& row : result.at("comparison"))
    fmt::print("{:<50}{:>8}{:>11}{:>11}{:>11}{:>11}\n", row.at("what").get<std::string>(), row.at("unit").get<std::string>(), value(row.at("published")), value(row.at("bound")),
               value(row.at("before")), value(row.at("measured")));
  fmt::print("\nwritten {}{}\n", (folder / "study.json").string(), drawn ? ", " + (folder / "study.html").string() : "");
}

/// What a study needs besides its events.
struct setup {
  scifi::detector detector = scifi::mice::trackers();
  scifi::fibre_doublet fibre;
  json before;
};

setup prepare(options& o, const ranks& all, const fs::path& target) {
  all.check_build();
  check(o);
  setup out;
  if (!o.geometry.empty()) {
    scifi::any_geometry geometry = scifi::read_any_geometry(o.geometry);
    for (const std::string& note : geometry.notes) fmt::print(stderr, "note: {}\n", note);
    if (!o.given_field)
      if (const auto field = geometry.common_field()) o.field = *field / scifi::units::tesla;
    out.detector = std::move(geometry.detector);
    out.fibre = geometry.fibre;
  }
  o.field = o.given_field.value_or(o.field);
  o.study.field = o.field * scifi::units::tesla;
  std::error_code none;
  if (!o.before.empty() && fs::equivalent(o.before, target, none)) throw std::invalid_argument(o.before + ": would overwrite what is read");
  if (!o.before.empty()) out.before = scifi::study_program::read_study(o.before);
  return out;
}

void run(options& o, const ranks& all) {
  const fs::path folder = o.output;
  const fs::path target = folder / "study.json";
  setup with;
  all.together([&] { with = prepare(o, all, target); });
  if (all.leads()) interruption::listen();
  std::optional<whole_study> found;
  all.together([&] { found = fill(o, all, with.detector, with.fibre); });
  scifi::study_program::gather(all, *found);
  if (!all.leads()) return;
  const json result = to_json(o, *found, with.before);

  std::error_code none;
  fs::create_directories(folder, none);
  if (!fs::is_directory(folder)) throw scifi::input_error(o.output, 0, "", "is not a folder and cannot be made one");
  scifi::atomic_file out(target);
  constexpr int indentation = 1;
  out.write(result.dump(indentation) + '\n');
  out.commit();
  if (!o.no_page) scifi::study_program::draw_page(target, folder, o.python);
  print_summary(result, folder, !o.no_page);
}

}  // namespace

int main(int argc, char** argv) {
  const ranks all(argc, argv);
  options o;
  CLI::App app{"Studies how well tracks were reconstructed: writes DIR/study.json with every number, DIR/*.png, DIR/*.svg and the page DIR/study.html.\n"
               "Units: mm, MeV/c, tesla; tracker frame. Tables may be gzip."};
  app.add_option("TRUTH", o.truth, "crossings of a simulation: event,track,pdg,tracker,station,plane,x_mm,y_mm,z_mm,px_MeV,py_MeV,pz_MeV")->required();
  app.add_option("TRACKS", o.tracks, "tracks, as scifi-reconstruct writes them")->required();
  app.add_option("--track-points", o.points, "the tracks at every plane: adds the pulls there");
  app.add_option("--digits", o.digits, "digits: adds their numbers, light and channel sums, and hits in the event displays");
  app.add_option("-o,--output", o.output, "DIR, made if it does not exist")->required();
  app.add_option("--before", o.before, "study.json of another study of the same kind, to be shown beside this one");
  app.add_option("--geometry", o.geometry, "geometry in JSON (.json) or MiceModules (.dat); the MICE trackers unless given");
  app.add_option("--field", o.given_field, "uniform field along z of the tracker frame, tesla; unless given that of the geometry, else 3");
  app.add_option("--min-npe", o.min_npe, "least light of a digit, photo-electrons")->capture_default_str();
  app.add_option("--min-stations", o.study.expected.min_stations, "a track is expected of a particle that crosses so many stations within the fiducial radius")->capture_default_str();
  app.add_option("--max-pt-over-pz", o.study.expected.max_pt_over_pz, "and whose pt/|pz| is below this")->capture_default_str();
  app.add_option("--pt-edges", o.study.edges.pt, "edges of the bins in true pt, MeV/c, with commas between")->delimiter(',')->capture_default_str();
  app.add_option("--pz-edges", o.study.edges.pz, "edges of the bins in true |pz|, MeV/c, with commas between")->delimiter(',')->capture_default_str();
  app.add_option("--wide-pt-edges", o.study.wide_edges.pt, "of those in which the momentum is looked at in two dimensions")->delimiter(',')->capture_default_str();
  app.add_option("--wide-pz-edges", o.study.wide_edges.pz, "likewise")->delimiter(',')->capture_default_str();
  app.add_option("--python", o.python, "Python 3 with matplotlib that draws; unless given the one on the path, else the system's");
  app.add_flag("--no-page", o.no_page, "write study.json alone");
  const int status = run_program("scifi-study", app, argc, argv, [&] { run(o, all); });
  if (all.size() > 1 && interruption::received() != 0) ranks::abort(status);
  return status;
}
