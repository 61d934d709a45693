// SPDX-License-Identifier: MPL-2.0
// scifi-digitise: raw ADC counts of scintillating-fibre trackers to digits, CSV or MICE JSON.
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <scifi/geometry/mice.hpp>
#include <scifi/io/any_geometry.hpp>
#include <scifi/io/atomic_file.hpp>
#include <scifi/io/bad_channels_text.hpp>
#include <scifi/io/cabling_text.hpp>
#include <scifi/io/calibration_json.hpp>
#include <scifi/io/digit_writer.hpp>
#include <scifi/io/mice_json_writer.hpp>
#include <scifi/io/raw_reader.hpp>
#include <scifi/readout_to_digit/readout_digitiser.hpp>
#include <scifi/version.hpp>

#include "conditions/stored_conditions.hpp"
#include "interruption.hpp"
#include "run_program.hpp"

namespace {

namespace fs = std::filesystem;

struct options {
  stored_conditions stored;
  std::string raw, cabling, calibration, bad_channels, geometry, output = "digits.csv";
  double min_npe = 2.0;
};

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code none;
  return fs::weakly_canonical(a, none) == fs::weakly_canonical(b, none) || fs::equivalent(a, b, none);
}

void check(const options& o) {
  if (!std::isfinite(o.min_npe) || o.min_npe < 0.0) throw std::invalid_argument("--min-npe: not a finite number from 0 on");
  if (o.output.ends_with(".gz")) throw std::invalid_argument("--output: " + o.output + ": gzip is read but not written");
  const auto require = [](const std::string& given, const char* option) {
    if (given.empty()) throw std::invalid_argument(std::string(option) + " is required");
  };
  require(o.cabling, "--cabling");
  require(o.calibration, "--calibration");
  require(o.bad_channels, "--bad-channels");
  for (const std::string& in : {o.raw, o.cabling, o.calibration, o.bad_channels, o.geometry, o.stored.store()})
    if (!in.empty() && same_file(in, o.output)) throw std::invalid_argument(o.output + ": would overwrite what is read");
}

/// The events as they are written: a table of digits, or MICE JSON where the name says .json.
class digit_output {
 public:
  explicit digit_output(const std::string& name) : file_(name), json_(name.ends_with(".json")) {
    if (!json_) file_.write(scifi::digit_columns);
  }

  void write(long number, const std::vector<scifi::raw_digit>& digits) {
    if (json_) {
      light_.clear();
      for (const scifi::raw_digit& d : digits) light_.push_back(d.seen());
      scifi::append_mice_spill(pending_, number, light_);
    } else {
      for (const scifi::raw_digit& d : digits) scifi::append_digit(pending_, number, d);
    }
    constexpr std::size_t block = std::size_t{1} << 20;
    if (pending_.size() >= block) flush();
  }
  void commit() {
    flush();
    file_.commit();
  }

 private:
  void flush() {
    file_.write(pending_);
    pending_.clear();
  }

  scifi::atomic_file file_;
  bool json_;
  std::string pending_;
  std::vector<scifi::digit> light_;
};

struct setup {
  std::size_t cables, calibrated, bad, without_cable;
};

std::size_t channels_of(const scifi::detector& d) {
  std::size_t sum = 0;
  for (const scifi::tracker& t : d.trackers)
    for (const scifi::station& s : t.stations)
      for (const scifi::plane& p : s.planes) sum += static_cast<std::size_t>(p.channels);
  return sum;
}

void print_summary(const options& o, const setup& with, long events, const scifi::readout_tally& sum, double seconds) {
  // Standard output may be where the digits go.
  std::FILE* const out = o.output.starts_with("/dev/") ? stderr : stdout;
  const auto row = [out](const char* name, auto count, std::string_view remark = "") { fmt::print(out, "{:<18}{:>12}{}\n", name, count, remark); };
  fmt::print(out, "scifi-digitise {}\n", scifi::version);
  fmt::print(out, "{:<18}{}, {}\n", "read", o.raw, o.geometry.empty() ? "MICE trackers as surveyed" : o.stored.origin(o.geometry));
  row("cables", with.cables, fmt::format("   {}; channels of the geometry without one {}", o.stored.origin(o.cabling), with.without_cable));
  row("calibrated", with.calibrated, "   " + o.stored.origin(o.calibration));
  row("bad channels", with.bad, "   " + o.stored.origin(o.bad_channels));
  row("events", events);
  row("counts", sum.counts());
  row("  not cabled", sum.not_cabled);
  row("  bad channel", sum.bad);
  row("  not calibrated", sum.not_calibrated);
  row("  too little light", sum.below_threshold, fmt::format("   less than {} photo-electrons", o.min_npe));
  row("  digits", sum.digits);
  fmt::print(out, "{:<18}{:>12.3f} s, {:.0f} events/s\n", "time", seconds, static_cast<double>(events) / seconds);
  fmt::print(out, "{:<18}{}\n", "written", o.output);
}

void run(options& o) {
  const auto start = std::chrono::steady_clock::now();
  o.stored.fill_in(o.geometry, scifi::condition_kind::geometry);
  o.stored.fill_in(o.cabling, scifi::condition_kind::cabling);
  o.stored.fill_in(o.calibration, scifi::condition_kind::calibration);
  o.stored.fill_in(o.bad_channels, scifi::condition_kind::bad_channels);
  check(o);
  const scifi::detector detector = o.geometry.empty() ? scifi::mice::trackers() : scifi::read_any_geometry(o.geometry).detector;
  const scifi::cabling_map cabling = scifi::read_cabling(o.cabling, detector);
  const scifi::readout_calibration calibration = scifi::read_calibration(o.calibration);
  const scifi::bad_channels bad = scifi::read_bad_channels(o.bad_channels);
  const setup with{cabling.cables().size(), calibration.size(), bad.size(), channels_of(detector) - cabling.cables().size()};
  const scifi::readout_digitiser digitise(cabling, calibration, bad, o.min_npe);

  interruption::listen();
  scifi::raw_reader source(o.raw);
  digit_output out(o.output);
  scifi::readout_tally sum;
  scifi::raw_event event;
  std::vector<scifi::raw_digit> digits;
  long events = 0;
  while (source.read(event)) {
    interruption::throw_if_received();
    sum += digitise(event.counts, digits);
    out.write(event.number, digits);
    ++events;
  }
  out.commit();
  print_summary(o, with, events, sum, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

}  // namespace

int main(int argc, char** argv) {
  options o;
  CLI::App app{"Makes digits of the raw ADC counts of scintillating-fibre trackers. All inputs may be gzip."};
  app.add_option("RAW", o.raw, "raw counts: CSV with the columns event, board, bank (of the board), channel, adc")->required();
  app.add_option("--cabling", o.cabling, "cabling, text: board bank channel tracker station plane channel and three numbers more a line");
  app.add_option("--calibration", o.calibration, "calibration, JSON: objects with bank (through all boards), channel, adc_pedestal, adc_gain");
  app.add_option("--bad-channels", o.bad_channels, "bad channels, text: bank (through all boards) and channel a line; may be empty");
  o.stored.offer(app);
  app.add_option("--geometry", o.geometry, "geometry in JSON or MiceModules that goes with the cabling; the MICE trackers unless given");
  app.add_option("--min-npe", o.min_npe, "least light of a digit, photo-electrons")->capture_default_str();
  app.add_option("-o,--output", o.output, "digits: MICE JSON, one event a spill, where the name ends in .json, else CSV")->capture_default_str();
  return run_program("scifi-digitise", app, argc, argv, [&o] { run(o); });
}
