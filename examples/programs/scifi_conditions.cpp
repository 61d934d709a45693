// SPDX-License-Identifier: MPL-2.0
// scifi-conditions: geometry, calibration, cabling and the like, each for an interval of runs and recorded at a time, in one file.
#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <scifi/conditions/conditions_store.hpp>
#include <scifi/conditions/document_check.hpp>
#include <scifi/io/any_geometry.hpp>
#include <scifi/io/atomic_file.hpp>
#include <scifi/io/bad_channels_text.hpp>
#include <scifi/io/cabling_text.hpp>

#include "run_program.hpp"

namespace {

namespace fs = std::filesystem;
using scifi::condition;
using scifi::condition_kind;
using scifi::conditions_store;

struct options {
  std::string store, kind, runs, run, recorded, as_of, comment, file, output;
  std::optional<int> tracker;
};

/// Names the option in what `read` has to say about its text.
template <class Read>
auto option_value(const char* name, const Read& read) {
  try {
    return read();
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument(std::string(name) + ": " + e.what());
  }
}

std::optional<condition_kind> kind_of(const options& o) {
  if (o.kind.empty()) return std::nullopt;
  if (const auto kind = scifi::condition_kind_from_name(o.kind)) return kind;
  std::string names;
  for (const condition_kind k : scifi::condition_kinds) names += (names.empty() ? "" : ", ") + std::string(name_of(k));
  throw std::invalid_argument("--kind: " + scifi::in_quotes(o.kind) + " is none of " + names);
}
scifi::run_number run_of(const options& o) {
  return option_value("--run", [&] { return scifi::run_number_from(o.run); });
}
/// A date alone takes in all that was recorded on that day.
std::optional<scifi::recorded_time> as_of(const options& o) {
  if (o.as_of.empty()) return std::nullopt;
  return option_value("--as-of", [&] { return scifi::recorded_time_from(o.as_of, scifi::date_alone::last_second); });
}

/// Text for a table: what would break its lines is shown as '?'.
std::string visible(std::string_view text) {
  std::string out(text);
  std::ranges::replace_if(out, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
  return out;
}
std::string tracker_text(const condition& c) { return c.tracker ? std::to_string(*c.tracker) : "all"; }

std::string sentence(const condition& c) {
  return fmt::format("record {}: {}, {}, runs {}, recorded {}, {} bytes from {}", c.id, name_of(c.kind),
                     c.tracker ? "tracker " + std::to_string(*c.tracker) : "all trackers", to_text(c.runs), scifi::to_text(c.recorded), c.length, visible(c.source));
}

void print_table(const std::vector<condition>& records, const std::vector<condition>* in_force) {
  if (records.empty()) {
    fmt::print(stderr, "scifi-conditions: no such record\n");
    return;
  }
  constexpr std::string_view row = "{:<2}{:>6}  {:<12} {:<7} {:<16} {:<20} {:<20} {:>10}  {:<12}  {}\n";
  fmt::print(row, "", "record", "kind", "tracker", "runs", "recorded", "written", "bytes", "sha256", "source, comment");
  for (const condition& c : records) {
    const bool marked = in_force != nullptr && std::ranges::any_of(*in_force, [&](const condition& f) { return f.id == c.id; });
    constexpr std::size_t enough_to_tell_apart = 12;
    fmt::print(row, marked ? "*" : "", c.id, name_of(c.kind), tracker_text(c), to_text(c.runs), scifi::to_text(c.recorded), scifi::to_text(c.written), c.length,
               c.sha256.substr(0, enough_to_tell_apart), visible(c.source) + (c.comment.empty() ? "" : ", " + visible(c.comment)));
  }
  if (in_force != nullptr) fmt::print("*: in force\n");
}

/// The checks of the library, and those whose readers need the file itself or, for cabling, the geometry that goes with it as known when it was recorded.
std::vector<scifi::document_check> checks_for(const options& o, const scifi::new_condition& given) {
  std::vector<scifi::document_check> checks = scifi::built_in_document_checks();
  checks.push_back({condition_kind::bad_channels, [&o](const std::string&, const std::string&) {
                      static_cast<void>(scifi::read_bad_channels(o.file));
                      return true;
                    }});
  checks.push_back({condition_kind::cabling, [&o, &given](const std::string&, const std::string&) {
                      if (!fs::exists(o.store)) return false;
                      const conditions_store store(o.store);
                      const auto geometry = store.find({.kind = condition_kind::geometry, .run = given.runs.first, .as_of = given.recorded, .tracker = {}});
                      if (!geometry) return false;
                      const std::string document = store.document(*geometry);
                      const std::string name = fmt::format("{}: record {}", o.store, geometry->id);
                      static_cast<void>(scifi::read_cabling(o.file, scifi::geometry_from_json(scifi::parse_json(document, name), name)));
                      return true;
                    }});
  return checks;
}

/// MiceModules name other files: what goes into the store is all that they say, as JSON.
void convert_mice_modules(const options& o, scifi::new_condition& given) {
  if (given.kind != condition_kind::geometry || scifi::looks_like_json(o.file)) return;
  const scifi::any_geometry geometry = scifi::read_any_geometry(o.file);
  for (const std::string& note : geometry.notes) fmt::print(stderr, "note: {}\n", note);
  constexpr int indentation = 1;
  given.document = scifi::geometry_to_json(geometry).dump(indentation) + '\n';
  given.source += " as JSON";
}

void add(const options& o) {
  scifi::new_condition given{.kind = *kind_of(o), .tracker = o.tracker, .runs = option_value("--runs", [&] { return scifi::run_interval_from(o.runs); }),
                             .recorded = {}, .source = fs::path(o.file).filename().string(), .comment = o.comment, .document = scifi::text_of_file(o.file)};
  if (!o.recorded.empty()) given.recorded = option_value("--recorded", [&] { return scifi::recorded_time_from(o.recorded); });
  convert_mice_modules(o, given);
  const bool checked = check_document(checks_for(o, given), given.kind, given.document, o.file);
  conditions_store store(o.store, conditions_store::access::write);
  const condition added = store.add(given);
  const char* const unchecked = added.kind == condition_kind::cabling ? "; not checked, for the store has no geometry for its first run"
                                                                      : "; not checked, for there is no reader for it";
  fmt::print("added {}{}\n", sentence(added), checked ? "" : unchecked);
  const std::vector<condition> records = store.all(added.kind);
  const auto hides = [&](const condition& c) {
    return c.recorded > added.recorded && (!c.tracker || c.tracker == added.tracker) && c.runs.first <= added.runs.last && added.runs.first <= c.runs.last;
  };
  if (const auto later = std::ranges::count_if(records, hides); later > 0)
    fmt::print("note: {} of the same runs recorded later stay{} in force\n", later == 1 ? "a record" : std::to_string(later) + " records", later == 1 ? "s" : "");
}

void get(const options& o) {
  std::error_code none;
  if (!o.output.empty() && fs::equivalent(o.store, o.output, none)) throw std::invalid_argument("--output: would overwrite the store");
  const conditions_store store(o.store);
  const condition found = store.get({.kind = *kind_of(o), .run = run_of(o), .as_of = as_of(o), .tracker = o.tracker});
  const std::string document = store.document(found);
  if (o.output.empty()) {
    if (std::fwrite(document.data(), 1, document.size(), stdout) != document.size() || std::fflush(stdout) != 0)
      throw std::system_error(errno, std::generic_category(), "standard output: could not be written");
    return;
  }
  scifi::atomic_file out(o.output);
  out.write(document);
  out.commit();
  fmt::print(o.output.starts_with("/dev/") ? stderr : stdout, "{}\nwritten {}\n", sentence(found), out.name());
}

void list(const options& o) {
  const auto kind = kind_of(o);
  const auto when = as_of(o);
  if (o.run.empty()) return print_table(conditions_store(o.store).all(kind, when), nullptr);
  const scifi::run_number run = run_of(o);
  print_table(conditions_store(o.store).in_force(run, kind, when), nullptr);
}

void history(const options& o) {
  const condition_kind kind = *kind_of(o);
  const scifi::run_number run = run_of(o);
  const auto when = as_of(o);
  const conditions_store store(o.store);
  const std::vector<condition> in_force = store.in_force(run, kind, when);
  print_table(store.history(kind, run, when), &in_force);
}

}  // namespace

int main(int argc, char** argv) {
  options o;
  void (*command)(const options&) = nullptr;
  CLI::App app{"A store of documents that describe the detector, each for an interval of runs and recorded at a time. For a run, the latest recorded is in force.\n"
               "Dates are UTC: 2015-11-05 or 2015-11-05T14:30:00Z. Nothing is ever overwritten."};
  app.add_option("STORE", o.store, "the file of the store; add makes it")->required();
  app.require_subcommand(1);
  const auto subcommand = [&](const char* name, const char* what, void (*does)(const options&)) {
    CLI::App* const sub = app.add_subcommand(name, what);
    sub->callback([&command, does] { command = does; });
    return sub;
  };
  const char* const kinds = "geometry, calibration, cabling, bad_channels or alignment";
  const char* const as_of_help = "what was known on that day (all of it) or at that time; now unless given";

  CLI::App* const to_add = subcommand("add", "adds a document", add);
  to_add->add_option("FILE", o.file, "the document; may be gzip, it is stored unpacked; a geometry in MiceModules is stored as JSON")->required();
  to_add->add_option("--kind", o.kind, kinds)->required();
  to_add->add_option("--runs", o.runs, "first and last run it is valid for, 7000:7999; without an end 7000:")->required();
  to_add->add_option("--tracker", o.tracker, "the tracker it is for; all unless given")->check(CLI::NonNegativeNumber);
  to_add->add_option("--recorded", o.recorded, "when it was recorded, if that was earlier; now unless given");
  to_add->add_option("--comment", o.comment, "why, for those who come after");

  CLI::App* const to_get = subcommand("get", "writes the document in force for a run", get);
  to_get->add_option("--kind", o.kind, kinds)->required();
  to_get->add_option("--run", o.run, "number of the run")->required();
  to_get->add_option("--tracker", o.tracker, "for this tracker: documents for it or for all; those for all alone unless given")->check(CLI::NonNegativeNumber);
  to_get->add_option("--as-of", o.as_of, as_of_help);
  to_get->add_option("-o,--output", o.output, "where to; standard output unless given");

  CLI::App* const to_list = subcommand("list", "lists all records or, with --run, those in force for it", list);
  to_list->add_option("--kind", o.kind, kinds);
  to_list->add_option("--run", o.run, "number of the run");
  to_list->add_option("--as-of", o.as_of, as_of_help);

  CLI::App* const to_tell = subcommand("history", "lists what was ever recorded for a run, the earliest first", history);
  to_tell->add_option("--kind", o.kind, kinds)->required();
  to_tell->add_option("--run", o.run, "number of the run")->required();
  to_tell->add_option("--as-of", o.as_of, as_of_help);
  return run_program("scifi-conditions", app, argc, argv, [&] { command(o); });
}
