// SPDX-License-Identifier: MPL-2.0
// scifi-display: events as one HTML file, in three dimensions, with a table of tracks; as events of the Phoenix display where asked for.
#include <cmath>
#include <exception>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/io/any_geometry.hpp>
#include <scifi/io/atomic_file.hpp>
#include <scifi/io/event_view_json.hpp>
#include <scifi/io/html_page.hpp>
#include <scifi/io/phoenix_json.hpp>

#include "conditions/stored_conditions.hpp"
#include "display/display_events.hpp"
#include "interruption.hpp"
#include "run_program.hpp"
#include "shared_page.hpp"

namespace {

namespace fs = std::filesystem;

struct options {
  stored_conditions stored;
  display_events::files from;
  std::string geometry, output = "display.html", phoenix, json, title;
  std::optional<double> given_field;  // tesla
  double min_npe = 2.0;
  long first = std::numeric_limits<long>::min(), events = 100;
};

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code none;
  return fs::weakly_canonical(a, none) == fs::weakly_canonical(b, none) || fs::equivalent(a, b, none);
}

void check(const options& o) {
  const auto require = [](bool good, const char* what) {
    if (!good) throw std::invalid_argument(what);
  };
  require(!o.from.digits.empty() || !o.from.tracks.empty(), "nothing to show: give digits, --tracks or both");
  require(o.from.track_points.empty() || !o.from.tracks.empty(), "--track-points: give the tracks that they are of with --tracks");
  require(std::isfinite(o.given_field.value_or(0.0)), "--field: not a finite number");
  require(std::isfinite(o.min_npe) && o.min_npe >= 0.0, "--min-npe: not a finite number from 0 on");
  const std::string* const written[] = {&o.output, &o.phoenix, &o.json};
  for (const std::string* out : written) {
    if (out->empty()) continue;
    for (const std::string& in : {o.from.digits, o.from.tracks, o.from.track_points, o.from.truth, o.geometry, o.stored.store()})
      if (!in.empty() && same_file(in, *out)) throw std::invalid_argument(*out + ": would overwrite what is read");
    for (const std::string* other : written)
      if (other != out && !other->empty() && same_file(*other, *out)) throw std::invalid_argument(*out + ": two documents in the same file");
  }
}

std::string title_of(const options& o) {
  if (!o.title.empty()) return o.title;
  return fs::path(o.from.digits.empty() ? o.from.tracks : o.from.digits).filename().string();
}

void write(const std::string& path, const std::string& content) {
  scifi::atomic_file file(path);
  file.write(content);
  file.commit();
}

void run(options& o) {
  o.stored.fill_in(o.geometry, scifi::condition_kind::geometry);
  check(o);
  const std::string page = shared_page("display.html");
  scifi::detector detector = scifi::mice::trackers();
  double field = 3.0;
  scifi::reconstruction_options choice{.min_npe = o.min_npe, .fibre = {}};
  if (!o.geometry.empty()) {
    scifi::any_geometry geometry = scifi::read_any_geometry(o.geometry);
    for (const std::string& note : geometry.notes) fmt::print(stderr, "note: {}\n", note);
    if (!o.given_field)
      if (const auto common = geometry.common_field()) field = *common / scifi::units::tesla;
    detector = std::move(geometry.detector);
    choice.fibre = geometry.fibre;
  }
  choice.field = o.given_field.value_or(field) * scifi::units::tesla;

  interruption::listen();
  display_events source(o.from, detector, choice);
  scifi::phoenix_events phoenix(detector, choice.field);
  nlohmann::ordered_json events = nlohmann::ordered_json::array();
  scifi::event e;
  scifi::truth truth;
  std::size_t tracks = 0;
  bool left_out = false;
  while (source.read(e, truth)) {
    interruption::throw_if_received();
    if (e.number < o.first) continue;
    left_out = static_cast<long>(events.size()) == o.events;
    if (left_out) break;
    events.push_back(scifi::event_view_json(detector, e, choice.field, o.from.truth.empty() ? nullptr : &truth));
    tracks += events.back()["tracks"].size();
    if (!o.phoenix.empty()) phoenix.add(e);
  }
  const std::size_t shown = events.size();
  const std::string document = scifi::event_view_document(detector, choice.field, title_of(o), std::move(events)).dump(-1, ' ', true);
  if (!o.phoenix.empty()) write(o.phoenix, phoenix.document().dump(-1, ' ', true) + '\n');
  if (!o.json.empty()) write(o.json, document + '\n');
  write(o.output, scifi::page_with_data(page, document));
  fmt::print("{:<16}{:>12}{}\n{:<16}{:>12}\n{:<16}{}{}{}\n", "events", shown,
             left_out ? "   (--events; there are more, --first says from where)" : "", "tracks", tracks, "written", o.output,
             o.phoenix.empty() ? "" : ", " + o.phoenix, o.json.empty() ? "" : ", " + o.json);
}

}  // namespace

int main(int argc, char** argv) {
  options o;
  CLI::App app{"Shows events in three dimensions: one HTML file that needs no network. Units: mm, MeV/c, tesla; tracker frame."};
  app.add_option("DIGITS", o.from.digits, "digits, CSV or MICE JSON (.json), as for scifi-reconstruct; reconstructed here unless --tracks is given");
  app.add_option("--tracks", o.from.tracks, "tracks, CSV of scifi-reconstruct");
  app.add_option("--track-points", o.from.track_points, "with --tracks: the tracks at every plane, CSV of scifi-reconstruct; tracks are drawn through them");
  app.add_option("--truth", o.from.truth, "where the true particles cross the planes, CSV of scifi-simulate");
  app.add_option("--geometry", o.geometry, "geometry in JSON (.json) or MiceModules (.dat); the MICE trackers unless given");
  o.stored.offer(app);
  app.add_option("--field", o.given_field, "uniform field along z of the tracker frame, tesla, that of the fit; 0: straight tracks; unless given that of the geometry, else 3");
  app.add_option("--min-npe", o.min_npe, "least light of a digit that a space point is made of, photo-electrons")->capture_default_str();
  app.add_option("--first", o.first, "number of the first event to show");
  app.add_option("--events", o.events, "how many events to show, at most")->check(CLI::Range(1L, 1000000L))->capture_default_str();
  app.add_option("--title", o.title, "title of the page; the name of the file unless given");
  app.add_option("--output", o.output, "the page, HTML")->capture_default_str();
  app.add_option("--phoenix", o.phoenix, "write the events for the Phoenix event display too, JSON");
  app.add_option("--json", o.json, "write the page's data too, JSON");
  return run_program("scifi-display", app, argc, argv, [&o] { run(o); });
}
