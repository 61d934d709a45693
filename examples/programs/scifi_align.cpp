// SPDX-License-Identifier: MPL-2.0
// scifi-align: shifts and rotations of stations or planes from the tracks through them; writes the corrected geometry.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/task_arena.h>

#include <scifi/alignment/tracker_alignment.hpp>
#include <scifi/chain/reconstruction.hpp>
#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/io/any_geometry.hpp>
#include <scifi/io/atomic_file.hpp>

#include "conditions/stored_conditions.hpp"
#include "reconstruct/command_line.hpp"
#include "reconstruct/event_source.hpp"
#include "reconstruct/ordered_blocks.hpp"
#include "reconstruct/progress.hpp"
#include "run_program.hpp"

namespace {

namespace alignment = scifi::alignment;

struct options {
  stored_conditions stored;
  std::string digits, geometry, output = "aligned.json", parameters, particle = "mu";
  double field = 0.0, min_npe = 2.0, momentum = 200.0, min_p_value = 0.001;
  std::string level = "stations", free = "both", frame = "ends";
  std::vector<int> hold, trackers;
  int passes = 10, min_planes = 0, threads = 0;
};

void check(const options& o) {
  const auto require = [](bool good, const char* what) {
    if (!good) throw std::invalid_argument(what);
  };
  require(std::isfinite(o.field), "--field: not a finite number");
  require(std::isfinite(o.min_npe) && o.min_npe >= 0.0, "--min-npe: not a finite number from 0 on");
  require(std::isfinite(o.momentum) && o.momentum > 0.0, "--momentum: not a finite number above 0");
  require(o.min_p_value >= 0.0 && o.min_p_value < 1.0, "--min-p-value: not in 0 .. 1");
  for (const std::string& out : {o.output, o.parameters})
    for (const std::string& in : {o.digits, o.geometry, o.stored.store()})
      if (!out.empty() && !in.empty() && same_file(in, out)) throw std::invalid_argument(out + ": would overwrite what is read");
  require(o.parameters.empty() || !same_file(o.output, o.parameters), "--output and --parameters: the same file");
  std::error_code none;
  if (std::filesystem::exists(o.digits, none) && !std::filesystem::is_regular_file(o.digits, none))
    throw std::invalid_argument(o.digits + ": is not a file: the digits are read once for each pass");
}

/// One tracker and how its alignment went.
struct aligned_tracker {
  alignment::tracker_alignment work;
  std::optional<alignment::tracker_sum> first, last;  // what the first and the last pass gathered
};

/// Reconstructs all events, read for the `whole` detector, in the geometry found so far and gathers the tracks; one sum for each of `trackers`.
std::vector<alignment::tracker_sum> pass(const options& o, const scifi::detector& whole, const scifi::reconstruction_options& choice,
                                         const std::vector<aligned_tracker>& trackers, int threads) {
  scifi::detector now;
  for (const aligned_tracker& t : trackers) now.trackers.push_back(t.work.where());
  const auto reconstruct = scifi::make_reconstruction(now, choice);
  using chain = std::remove_cvref_t<decltype(reconstruct)>;
  using collector = alignment::track_collector<std::remove_cvref_t<decltype(reconstruct.trackers().front().fit_track)>>;

  std::vector<collector> collect;
  std::vector<alignment::tracker_sum> sums, empty;
  for (std::size_t i = 0; i < trackers.size(); ++i) {
    collect.emplace_back(trackers[i].work.parameters(), reconstruct.trackers()[i].fit_track, trackers[i].work.cuts());
    empty.push_back(collect.back().empty());
  }
  sums = empty;

  struct block : event_block {
    std::vector<alignment::tracker_sum> sums;
  };
  struct memory {
    typename chain::buffers reconstruction;
    typename collector::buffers collection;
  };
  tbb::enumerable_thread_specific<memory> memories;
  event_source source(o.digits, whole);  // digits of trackers that are not aligned are no mistake
  progress display(source.file().size());
  long events = 0;
  const auto work = [&](block& b) {
    memory& m = memories.local();
    b.sums = empty;
    const std::span events(b.events.data(), b.used);
    reconstruct(events, m.reconstruction);
    for (const scifi::event& e : events)
      for (std::size_t k = 0; k < collect.size(); ++k) collect[k](e, b.sums[k], m.collection);
  };
  const auto add = [&](const block& b, std::uintmax_t bytes_read) {
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += b.sums[k];
    events += static_cast<long>(b.used);
    display.update(bytes_read, events);
  };
  if (const std::exception_ptr stopped = run_ordered_blocks<block>(source, threads, work, add)) std::rethrow_exception(stopped);
  return sums;
}

/// A mode in words: the parameters that are most of it.
std::string in_words(const alignment::mode& m, const alignment::tracker_parameters& parameters) {
  std::vector<std::pair<double, int>> parts;
  for (int i = 0; i < parameters.size(); ++i) parts.emplace_back(-std::abs(m.weights[i]), i);
  std::sort(parts.begin(), parts.end());
  std::string out;
  constexpr std::size_t most = 4;
  for (std::size_t k = 0; k < std::min(most, parts.size()) && -parts[k].first > 0.2; ++k)
    out += fmt::format("{}{:+.2f} {}", out.empty() ? "" : ", ", m.weights[parts[k].second], name_of(parameters[parts[k].second]));
  return out;
}

[[noreturn]] void give_up(const aligned_tracker& t) {
  const alignment::solution& s = t.work.last();
  std::string what = fmt::format("tracker {}: {}", t.work.where().id, describe(s.status));
  for (int i = 0; i < s.undetermined; ++i) what += "\n  not determined: " + in_words(s.modes[static_cast<std::size_t>(i)], t.work.parameters());
  throw std::runtime_error(what);
}

double per_ndf(double chi2, long ndf) { return ndf > 0 ? chi2 / static_cast<double>(ndf) : 0.0; }

nlohmann::ordered_json to_json(const aligned_tracker& t, alignment::frame keep) {
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

void print(const aligned_tracker& t) {
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

void run(options& o) {
  static const std::map<std::string, alignment::frame> frames{{"ends", alignment::frame::ends}, {"average", alignment::frame::average}, {"none", alignment::frame::none}};
  o.stored.fill_in(o.geometry, scifi::condition_kind::geometry);
  check(o);
  scifi::any_geometry geometry;
  if (o.geometry.empty()) geometry.detector = scifi::mice::trackers();
  else geometry = scifi::read_any_geometry(o.geometry);
  for (const std::string& note : geometry.notes) fmt::print(stderr, "note: {}\n", note);

  const scifi::reconstruction_options choice{.field = o.field * scifi::units::tesla,
                                             .hypothesis = hypothesis_named(o.particle),
                                             .min_npe = o.min_npe,
                                             .line_momentum = o.momentum,
                                             .fibre = geometry.fibre};
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

  const int threads = o.threads > 0 ? o.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  const auto settled = [&trackers] { return std::all_of(trackers.begin(), trackers.end(), [](const aligned_tracker& t) { return t.work.settled(); }); };
  for (int i = 0; i < o.passes && !settled(); ++i) {
    std::vector<alignment::tracker_sum> sums = arena.execute([&] { return pass(o, geometry.detector, choice, trackers, threads); });
    for (std::size_t k = trackers.size(); k-- > 0;) {
      aligned_tracker& t = trackers[k];
      if (sums[k].equations.tracks() == 0) {
        fmt::print(stderr, "note: tracker {}: no tracks; it is left as it is\n", t.work.where().id);
        trackers.erase(trackers.begin() + static_cast<std::ptrdiff_t>(k));
        continue;
      }
      t.work.step(sums[k]);
      if (t.work.last().status != alignment::failure::none) give_up(t);
      if (!t.first) t.first = sums[k];
      t.last = std::move(sums[k]);
    }
    if (trackers.empty()) throw std::runtime_error(o.digits + ": no tracks to align with");
  }

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
                                             {"digits", o.digits},
                                             {"geometry", o.geometry.empty() ? "MICE trackers as surveyed" : o.stored.origin(o.geometry)},
                                             {"field_tesla", o.field},
                                             {"level", o.level},
                                             {"free", o.free},
                                             {"frame", o.frame},
                                             {"held_stations", o.hold},
                                             {"trackers", std::move(results)}};
    report->write(document.dump(2) + '\n');
    report->commit();
  }
  aligned.commit();
  fmt::print("scifi-align: {}, {}\n", o.digits, o.field != 0.0 ? fmt::format("helices in {} T", o.field) : fmt::format("straight tracks, scattering of {} MeV/c", o.momentum));
  for (const aligned_tracker& t : trackers) print(t);
  fmt::print("\nwritten {}{}\n", o.output, o.parameters.empty() ? "" : ", " + o.parameters);
}

}  // namespace

int main(int argc, char** argv) {
  options o;
  CLI::App app{"Aligns scintillating-fibre trackers with the tracks through them (Millepede's method). Units: mm, rad, MeV/c, tesla; tracker frame."};
  app.add_option("DIGITS", o.digits, "digits: CSV with the columns event, tracker, station, plane, channel, npe, or MICE JSON (.json); may be gzip")->required();
  app.add_option("--geometry", o.geometry, "geometry to start from, JSON (.json) or MiceModules (.dat); the MICE trackers unless given");
  o.stored.offer(app);
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
  app.add_option("--field", o.field, "uniform field along z of the tracker frame, tesla; 0: straight tracks")->capture_default_str();
  app.add_option("--particle", o.particle, "particle whose mass the fit assumes: mu, pi, e, p")->capture_default_str();
  app.add_option("--min-npe", o.min_npe, "least light of a digit, photo-electrons")->capture_default_str();
  app.add_option("--momentum", o.momentum, "momentum along z assumed for straight tracks, MeV/c")->capture_default_str();
  app.add_option("--passes", o.passes, "at most so many passes over the digits; it ends when no parameter moves by more than a tenth of its error")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_option("--min-planes", o.min_planes, "least measurements of a track; 0: four fifths of the planes")->check(CLI::Range(0, 1000))->capture_default_str();
  app.add_option("--min-p-value", o.min_p_value, "least probability of a track's chi2, once the scale of all is known")->capture_default_str();
  app.add_option("--threads", o.threads, "number of threads; 0: all cores. The output does not depend on it")->check(CLI::Range(0, 1024))->capture_default_str();
  return run_program("scifi-align", app, argc, argv, [&o] { run(o); });
}
