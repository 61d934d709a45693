// SPDX-License-Identifier: MPL-2.0
// scifi-reconstruct: tracks in the digits of scintillating-fibre trackers, from CSV or MICE JSON to CSV.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/task_arena.h>
#include <CLI/CLI.hpp>

#include <scifi/chain/reconstruction.hpp>
#include <scifi/core/pack.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/io/any_geometry.hpp>
#include <scifi/track_model/nystrom_propagator.hpp>
#include <scifi/version.hpp>

#include "conditions/stored_conditions.hpp"
#include "field/chosen_field.hpp"
#include "reconstruct/check_sum.hpp"
#include "reconstruct/event_block.hpp"
#include "reconstruct/event_pipeline.hpp"
#include "reconstruct/monitor.hpp"
#include "reconstruct/ranks.hpp"
#include "reconstruct/run_on_ranks.hpp"
#include "reconstruct/track_tables.hpp"
#include "run_program.hpp"

namespace {

namespace fs = std::filesystem;

struct options {
  stored_conditions stored;
  monitor watch;
  std::string digits, geometry, output = "tracks.csv", track_points, particle = "mu";
  chosen_field field;
  double min_npe = 2.0, momentum = 200.0;
  int threads = 0;
  bool resume = false;
};

/// A particle by its name; a name without a sign means the positive one, for the beam of MICE is.
scifi::particle hypothesis_named(const std::string& name) {
  const auto found = scifi::particle_from_name(name);
  if (!found) throw std::invalid_argument("--particle: '" + name + "' is not known; try mu, pi, e or p");
  const bool without_sign = name == "mu" || name == "muon" || name == "pi" || name == "pion" || name == "e";
  return without_sign && found->charge < 0 ? scifi::charge_conjugate(*found) : *found;
}

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code none;
  return fs::weakly_canonical(a, none) == fs::weakly_canonical(b, none) || fs::equivalent(a, b, none);
}

void check(const options& o) {
  const auto require = [](bool good, const char* what) {
    if (!good) throw std::invalid_argument(what);
  };
  require(std::isfinite(o.min_npe) && o.min_npe >= 0.0, "--min-npe: not a finite number from 0 on");
  require(std::isfinite(o.momentum) && o.momentum > 0.0, "--momentum: not a finite number above 0");
  require(o.threads >= 0 && o.threads <= 1024, "--threads: not in 0 .. 1024");
  for (const std::string& out : {o.output, o.track_points, o.watch.path()}) {
    for (const std::string& in : {o.digits, o.geometry, o.stored.store(), o.field.file()})
      if (!out.empty() && !in.empty() && same_file(in, out)) throw std::invalid_argument(out + ": would overwrite what is read");
  }
  require(o.track_points.empty() || !same_file(o.output, o.track_points), "--output and --track-points: the same file");
  for (const std::string& out : {o.output, o.track_points})
    require(o.watch.path().empty() || out.empty() || !same_file(o.watch.path(), out), "--monitor: the same file as another output");
}

/// What the results depend on besides the digits.
nlohmann::ordered_json settings_of(const options& o) {
  std::error_code none;
  const auto content = [](const std::string& file) { return fmt::format("a file of check sum {:08x}", check_sum::of(file).check); };
  return {{"the program", fmt::format("{}, {} tracks at a time", scifi::version, scifi::native_lanes<double>)},
          {"--geometry", o.geometry.empty() ? "the MICE trackers" : content(o.geometry)},
          {"--field", o.field.given() + (fs::is_regular_file(o.field.file(), none) ? ", " + content(o.field.file()) : "")},
          {"--particle", o.particle},
          {"--min-npe", o.min_npe},
          {"--momentum", o.momentum},
          {"--track-points", !o.track_points.empty()},
          {"--monitor", !o.watch.path().empty()}};
}

void print_summary(const options& o, const totals& sum, long before, const scifi::particle& hypothesis, const std::string& processors, double seconds) {
  // Standard output may be where the tracks go.
  std::FILE* const out = o.output.starts_with("/dev/") || o.track_points.starts_with("/dev/") ? stderr : stdout;
  const auto row = [out](const char* name, long count, const std::string& remark = "") { fmt::print(out, "{:<16}{:>12}{}\n", name, count, remark); };
  fmt::print(out, "scifi-reconstruct {}   units: mm, MeV/c, tesla\n", scifi::version);
  fmt::print(out, "{:<16}{}, {}, {}\n", "read", o.digits, o.geometry.empty() ? "MICE trackers as surveyed" : o.stored.origin(o.geometry),
             o.field.none() ? fmt::format("no field, straight lines at {} MeV/c, mass of {}", o.momentum, hypothesis.name)
                            : fmt::format("{}, helices, mass of {}", o.field.description(), hypothesis.name));
  row("events", sum.events, before > 0 ? fmt::format("   {} of them before this run", before) : "");
  row("digits", sum.digits);
  row("clusters", sum.clusters);
  row("space points", sum.space_points);
  row("candidates", sum.candidates);
  row("tracks", sum.tracks);
  row("failures", sum.failures);
  row("events flagged", sum.flagged,
      fmt::format("   combinations limited {}, fit failed {}", sum.combinations_limited, sum.fit_failed));
  fmt::print(out, "{:<16}{:>12.3f} s, {:.0f} events/s, {}\n", "time", seconds, static_cast<double>(sum.events - before) / seconds, processors);
  fmt::print(out, "{:<16}reconstruction {:.1f} us, on one thread\n", "time per event",
             std::chrono::duration<double, std::micro>(sum.reconstruction).count() / static_cast<double>(std::max(sum.events, 1L)));
  fmt::print(out, "{:<16}{}{}\n", "written", o.output, o.track_points.empty() ? "" : ", " + o.track_points);
}

void say(const std::string& what) {
  if (!what.empty()) fmt::print(stderr, "scifi-reconstruct: {}\n", what);
}

/// Everything is read, or reading was stopped: gives the tables their names, or keeps what there is and throws.
void finish(track_tables& tables, const block_reader& reader) {
  if (interruption::received() != 0) {
    const std::string kept = tables.keep("signal");
    throw kept.empty() ? interruption::interrupted() : interruption::interrupted(kept);
  }
  if (reader.mistake()) {
    try {
      std::rethrow_exception(reader.mistake());
    } catch (const scifi::input_error&) {
      say(tables.keep("mistake"));
      throw;
    }
  }
  tables.commit();
}

template <class Reconstruction>
void write_tracks(options& o, const ranks& all, const scifi::detector& detector, const scifi::particle& hypothesis, std::chrono::steady_clock::time_point start,
                  const Reconstruction& reconstruct) {
  const monitor::counts counts = o.watch.counts_of(detector);
  if (!all.leads()) {
    on_ranks::follow(all, reconstruct, !o.track_points.empty(), counts);
    return;
  }
  on_ranks::workers others(all);
  interruption::listen();
  event_source source(o.digits, detector);
  o.watch.prepare(detector);
  track_tables tables(o.output, o.track_points, settings_of(o), o.resume, o.watch);
  block_reader reader(source);
  const long before = tables.sum().events;
  if (const auto& last = tables.resumed()) reader.skip(last->sum.events, last->input_check);
  if (o.resume) say(before > 0 ? fmt::format("goes on after {} events", before) : "nothing to go on with: from the beginning");
  o.watch.start(o.digits);
  const int threads = o.threads > 0 ? o.threads : tbb::info::default_concurrency();
  progress display(source.file().size());
  try {
    if (all.size() > 1) {
      on_ranks::lead(others, all, reader, reconstruct, tables, display, counts);
    } else {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
      tbb::task_arena(threads).execute([&] { run_pipeline(reader, reconstruct, tables, threads, display, counts); });
    }
  } catch (const interruption::interrupted&) {
    // What is written is in order: `finish` keeps it.
  } catch (...) {
    display.clear();
    if (tables.saved()) say("what was written before is kept; --resume goes on from there");
    throw;
  }
  display.clear();
  finish(tables, reader);
  o.watch.end("done");
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  print_summary(o, tables.sum(), before, hypothesis, all.size() > 1 ? fmt::format("{} ranks", all.size()) : fmt::format("{} thread{}", threads, threads == 1 ? "" : "s"), seconds);
}

/// What a reconstruction needs besides the digits.
struct setup {
  scifi::particle hypothesis;
  scifi::detector detector = scifi::mice::trackers();
  std::optional<scifi::any_geometry> geometry;
  scifi::reconstruction_options choice;
};

setup prepare(options& o, const ranks& all) {
  all.check_build();
  o.stored.fill_in(o.geometry, scifi::condition_kind::geometry);
  check(o);
  if (all.size() > 1 && o.threads > 1) throw std::invalid_argument("--threads: under mpirun every rank is one thread; start more ranks");
  setup out{.hypothesis = hypothesis_named(o.particle), .geometry = {}, .choice = {}};
  out.choice = {.hypothesis = out.hypothesis, .min_npe = o.min_npe, .line_momentum = o.momentum, .fibre = {}};
  if (!o.geometry.empty()) {
    out.geometry = scifi::read_any_geometry(o.geometry);
    for (const std::string& note : out.geometry->notes) fmt::print(stderr, "note: {}\n", note);
    out.detector = out.geometry->detector;
    out.choice.fibre = out.geometry->fibre;
  }
  o.field.resolve(out.detector, out.geometry ? &*out.geometry : nullptr);
  return out;
}

void run(options& o, const ranks& all) {
  const auto start = std::chrono::steady_clock::now();
  std::optional<setup> with;
  all.together([&] { with = prepare(o, all); });
  if (o.field.mapped())
    write_tracks(o, all, with->detector, with->hypothesis, start, scifi::make_reconstruction(with->detector, with->choice, [&o](const scifi::tracker& t) {
                   // A thousandth of the resolution of a plane is lost at most.
                   constexpr scifi::nystrom_options steps{1e-2};
                   const tracker_field& f = o.field.in(t);
                   return scifi::tracker_flight<scifi::nystrom_propagator<scifi::field_map>>{{*f.map, steps}, f.mean};
                 }));
  else
    write_tracks(o, all, with->detector, with->hypothesis, start, scifi::make_reconstruction(with->detector, with->choice, [&o](const scifi::tracker& t) {
                   const double field = o.field.in(t).mean;
                   return scifi::tracker_flight<scifi::helix_propagator>{{field}, field};
                 }));
}

}  // namespace

int main(int argc, char** argv) {
  const ranks all(argc, argv);
  options o;
  CLI::App app{"Reconstructs tracks from the digits of scintillating-fibre trackers. Units: mm, ns, MeV, MeV/c, tesla; tracker frame."};
  app.add_option("DIGITS", o.digits, "digits: CSV with the columns event, tracker, station, plane, channel, npe, or MICE JSON (.json); may be gzip")
      ->required();
  app.add_option("--geometry", o.geometry, "geometry in JSON (.json) or MiceModules (.dat); the MICE trackers unless given");
  o.stored.offer(app);
  o.field.offer(app);
  app.add_option("--particle", o.particle, "particle whose mass the fit assumes: mu, pi, e, p")->capture_default_str();
  app.add_option("--min-npe", o.min_npe, "least light of a digit, photo-electrons")->capture_default_str();
  app.add_option("--momentum", o.momentum, "momentum along z assumed for straight tracks, MeV/c")->capture_default_str();
  app.add_option("--output", o.output, "tracks, CSV")->capture_default_str();
  app.add_option("--track-points", o.track_points, "the tracks at every plane, CSV; not written unless given");
  app.add_option("--threads", o.threads, "number of threads; 0: all cores. The output does not depend on it")->capture_default_str();
  app.add_flag("--resume", o.resume, "go on where an earlier run with the same options was stopped, be it killed; from the beginning where there is none");
  o.watch.offer(app);
  const int status = run_program("scifi-reconstruct", app, argc, argv, [&] { run(o, all); });
  if (all.size() > 1 && interruption::received() != 0) ranks::abort(status);
  return status;
}
