// SPDX-License-Identifier: MPL-2.0
// scifi-geometry: a geometry, JSON or MiceModules, as a table; written as JSON and drawn as SVG where asked for.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <scifi/core/units.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/io/any_geometry.hpp>
#include <scifi/io/atomic_file.hpp>
#include <scifi/io/geometry_svg.hpp>

#include "run_program.hpp"

namespace {

namespace fs = std::filesystem;

struct options {
  std::string geometry, json, svg;
};

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code none;
  return fs::weakly_canonical(a, none) == fs::weakly_canonical(b, none) || fs::equivalent(a, b, none);
}

void check(const options& o) {
  for (const std::string& out : {o.json, o.svg})
    if (!out.empty() && !o.geometry.empty() && same_file(o.geometry, out)) throw std::invalid_argument(out + ": would overwrite what is read");
  if (!o.json.empty() && !o.svg.empty() && same_file(o.json, o.svg)) throw std::invalid_argument("--json and --svg: the same file");
}

void print_planes(const scifi::station& s) {
  for (std::size_t i = 0; i < s.planes.size(); ++i) {
    const scifi::plane& p = s.planes[i];
    fmt::print("    {:>5} {:>5} {:>9.3f} {:>8} {:>8.1f} {:>9.4f} {:>11.5f} {:>10.5f}  ", i, p.view, p.angle / scifi::units::degree, p.channels,
               p.central_channel, p.channel_width, p.z_reference, p.z_measured);
    const char* separator = "";
    for (const auto* stack : {&p.below, &p.above})
      for (const scifi::slab& sheet : *stack) {
        fmt::print("{}{} {:.4f}", separator, sheet.medium.name, sheet.thickness);
        separator = " | ";
      }
    fmt::print("\n");
  }
}

bool same_planes(const scifi::station& a, const scifi::station& b) {
  if (a.planes.size() != b.planes.size()) return false;
  const auto same_sheets = [](const scifi::slab_stack<4>& x, const scifi::slab_stack<4>& y) {
    bool same = x.size() == y.size();
    for (std::size_t i = 0; same && i < x.size(); ++i) same = x[i].thickness == y[i].thickness && x[i].medium == y[i].medium;
    return same;
  };
  for (std::size_t i = 0; i < a.planes.size(); ++i) {
    const scifi::plane& p = a.planes[i];
    const scifi::plane& q = b.planes[i];
    if (p.view != q.view || p.angle != q.angle || p.channels != q.channels || p.central_channel != q.central_channel || p.channel_width != q.channel_width ||
        p.z_reference != q.z_reference || p.z_measured != q.z_measured || !same_sheets(p.below, q.below) || !same_sheets(p.above, q.above))
      return false;
  }
  return true;
}

void print_tracker(const scifi::tracker& t, const std::string& field) {
  fmt::print("\ntracker {}  {}   beam towards {}z   active radius {:g}, fiducial radius {:g}   {}   field {}\n", t.id, t.name, t.beam_direction > 0 ? '+' : '-',
             t.active_radius, t.fiducial_radius, t.gas.name, field);
  fmt::print("  {:>7} {:>9} {:>9} {:>10} {:>9}   x/X0 of all planes\n", "station", "x", "y", "z", "rotation");
  for (const scifi::station& s : t.stations) {
    double radiation_lengths = 0.0;
    for (const scifi::plane& p : s.planes) radiation_lengths += scifi::radiation_lengths(p.below) + scifi::radiation_lengths(p.above);
    const auto& o = s.in_tracker.origin;
    fmt::print("  {:>7} {:>9.4f} {:>9.4f} {:>10.4f} {:>9.4f}   {:.5f}\n", s.id, o.x(), o.y(), o.z(), s.in_tracker.angle / scifi::units::degree,
               radiation_lengths);
  }
  std::size_t first = 0;
  while (first < t.stations.size()) {
    std::size_t end = first + 1;
    while (end < t.stations.size() && same_planes(t.stations[first], t.stations[end])) ++end;
    fmt::print("  planes of station{} {}{}\n", end - first > 1 ? "s" : "", t.stations[first].id,
               end - first > 1 ? fmt::format(" to {}", t.stations[end - 1].id) : "");
    fmt::print("    {:>5} {:>5} {:>9} {:>8} {:>8} {:>9} {:>11} {:>10}  sheets in order of z\n", "plane", "view", "angle", "channels", "central", "width",
               "z reference", "z measured");
    print_planes(t.stations[first]);
    first = end;
  }
}

void write(const std::string& path, const std::string& content) {
  scifi::atomic_file file(path);
  file.write(content);
  file.commit();
}

/// What the programs take where no geometry is given.
scifi::any_geometry surveyed() {
  scifi::any_geometry g;
  g.detector = scifi::mice::trackers();
  g.field.resize(g.detector.trackers.size());
  return g;
}

void run(const options& o) {
  check(o);
  const scifi::any_geometry g = o.geometry.empty() ? surveyed() : scifi::read_any_geometry(o.geometry);
  fmt::print("{}   units: mm, degree, tesla; stations in the tracker frame, planes in the station frame\n", o.geometry.empty() ? "MICE trackers as surveyed" : o.geometry);
  for (std::size_t i = 0; i < g.detector.trackers.size(); ++i)
    print_tracker(g.detector.trackers[i], g.field[i] ? fmt::format("{:g} T", *g.field[i] / scifi::units::tesla) : "not given");
  const scifi::fibre_doublet& f = g.fibre;
  fmt::print("\nfibres   diameter {:g}, core {:g}, pitch {:g}, rows {:.5f} apart, {} a channel\n", f.diameter, f.core_diameter, f.pitch, f.row_separation,
             f.fibres_per_channel);
  for (const std::string& note : g.notes) fmt::print(stderr, "note: {}\n", note);
  if (!o.json.empty()) write(o.json, scifi::geometry_to_json(g).dump(2) + '\n');
  if (!o.svg.empty()) write(o.svg, scifi::geometry_to_svg(g.detector, g.fibre));
}

}  // namespace

int main(int argc, char** argv) {
  options o;
  CLI::App app{"Prints a geometry of trackers as a table, converts it to JSON and draws it."};
  app.add_option("GEOMETRY", o.geometry, "geometry in JSON (.json) or MiceModules (.dat), may be gzip; the MICE trackers unless given");
  app.add_option("--json", o.json, "write the geometry as JSON to this file");
  app.add_option("--svg", o.svg, "draw the geometry to this file: planes from the front, stations from the side");
  return run_program("scifi-geometry", app, argc, argv, [&o] { run(o); });
}
