// SPDX-License-Identifier: MPL-2.0
// scifi-reconstruct: tracks in the digits of scintillating-fibre trackers, from CSV or MICE JSON to CSV.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <oneapi/tbb/enumerable_thread_specific.h>

#include <scifi/chain/reconstruction.hpp>
#include <scifi/core/pack.hpp>
#include <scifi/io/any_geometry.hpp>
#include <scifi/version.hpp>

#include "field/chosen_flight.hpp"
#include "interruption.hpp"
#include "ranks.hpp"
#include "reconstruct/chains.hpp"
#include "reconstruct/check_sum.hpp"
#include "reconstruct/command_line.hpp"
#include "reconstruct/event_block.hpp"
#include "reconstruct/event_source.hpp"
#include "reconstruct/monitor.hpp"
#include "reconstruct/ordered_blocks.hpp"
#include "reconstruct/progress.hpp"
#include "reconstruct/run_on_ranks.hpp"
#include "reconstruct/track_block.hpp"
#include "reconstruct/track_tables.hpp"
#include "run_program.hpp"

namespace {

namespace fs = std::filesystem;

struct options {
  reconstruction_input in;
  monitor watch;
  std::string output = "tracks.csv", track_points;
  bool resume = false;
};

/// What the results depend on besides the digits.
nlohmann::ordered_json settings_of(const options& o) {
  std::error_code none;
  const auto content = [](const std::string& file) { return fmt::format("a file of check sum {:08x}", check_sum::of(file).check); };
  return {{"the program", fmt::format("{}, {} tracks at a time", scifi::version, scifi::native_lanes<double>)},
          {"--geometry", o.in.geometry.empty() ? "the MICE trackers" : content(o.in.geometry)},
          {"--field", o.in.field.given() + (fs::is_regular_file(o.in.field.file(), none) ? ", " + content(o.in.field.file()) : "")},
          {"--particle", o.in.particle},
          {"--min-npe", o.in.min_npe},
          {"--momentum", o.in.momentum},
          {"--track-points", !o.track_points.empty()},
          {"--monitor", !o.watch.path().empty()}};
}

void print_summary(const options& o, const totals& sum, long before, const scifi::particle& hypothesis, const std::string& processors, double seconds) {
  // Standard output may be where the tracks go.
  std::FILE* const out = o.output.starts_with("/dev/") || o.track_points.starts_with("/dev/") ? stderr : stdout;
  const auto row = [out](const char* name, long count, const std::string& remark = "") { fmt::print(out, "{:<16}{:>12}{}\n", name, count, remark); };
  fmt::print(out, "scifi-reconstruct {}   units: mm, MeV/c, tesla\n", scifi::version);
  fmt::print(out, "{:<16}{}, {}, {}\n", "read", o.in.digits, o.in.geometry_name(),
             o.in.field.none() ? fmt::format("no field, straight lines at {} MeV/c, mass of {}", o.in.momentum, hypothesis.name)
                               : fmt::format("{}, helices, mass of {}", o.in.field.description(), hypothesis.name));
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

template <class Chain>
void write_tracks(options& o, const ranks& all, const Chain& chain, const scifi::particle& hypothesis, std::chrono::steady_clock::time_point start) {
  const scifi::detector& detector = chain.where();
  const monitor::counts counts = o.watch.counts_of(detector);
  if (!all.leads()) {
    on_ranks::follow(all, chain, !o.track_points.empty(), counts);
    return;
  }
  on_ranks::workers others(all);
  interruption::listen();
  event_source source(o.in.digits, detector);
  o.watch.prepare(detector);
  track_tables tables(o.output, o.track_points, settings_of(o), o.resume, o.watch);
  block_reader reader(source);
  const long before = tables.sum().events;
  if (const auto& last = tables.resumed()) reader.skip(last->sum.events, last->input_check);
  if (o.resume) say(before > 0 ? fmt::format("goes on after {} events", before) : "nothing to go on with: from the beginning");
  o.watch.start(o.in.digits);
  const int threads = number_of_threads(o.in.threads);
  progress display(source.file().size());
  try {
    if (all.size() > 1) {
      on_ranks::lead(others, all, reader, chain, tables, display, counts);
    } else {
      tbb::enumerable_thread_specific<typename Chain::buffers> buffers;
      track_block empty;
      empty.seen = counts;
      run_ordered_blocks(
          reader, threads, empty, [&](track_block& b) { work_on(b, chain, buffers.local(), tables.with_points()); },
          [&](const track_block& b, std::uintmax_t bytes_read) {
            tables.write(b);
            display.update(bytes_read, tables.sum().events);
          });
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
  scifi::any_geometry geometry;
  scifi::reconstruction_options choice;
};

setup prepare(options& o, const ranks& all) {
  all.check_build();
  if (all.size() > 1 && o.in.threads > 1) throw std::invalid_argument("--threads: under mpirun every rank is one thread; start more ranks");
  setup out{.geometry = o.in.prepare({o.output, o.track_points, o.watch.path()}), .choice = {}};
  out.choice = o.in.choice(out.geometry);
  return out;
}

void run(options& o, const ranks& all) {
  const auto start = std::chrono::steady_clock::now();
  std::optional<setup> with;
  all.together([&] { with = prepare(o, all); });
  with_flight(o.in.field, [&](const auto& flight_in) {
    write_tracks(o, all, make_chain(with->geometry.detector, with->choice, flight_in), with->choice.hypothesis, start);
  });
}

}  // namespace

int main(int argc, char** argv) {
  const ranks all(argc, argv);
  options o;
  CLI::App app{"Reconstructs tracks from the digits of scintillating-fibre trackers. Units: mm, ns, MeV, MeV/c, tesla; tracker frame."};
  o.in.offer(app);
  app.add_option("--output", o.output, "tracks, CSV")->capture_default_str();
  app.add_option("--track-points", o.track_points, "the tracks at every plane, CSV; not written unless given");
  app.add_flag("--resume", o.resume, "go on where an earlier run with the same options was stopped, be it killed; from the beginning where there is none");
  o.watch.offer(app);
  const int status = run_program("scifi-reconstruct", app, argc, argv, [&] { run(o, all); });
  if (all.size() > 1 && interruption::received() != 0) ranks::abort(status);
  return status;
}
