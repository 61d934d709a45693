// SPDX-License-Identifier: MPL-2.0
// scifi-compare-simulation: the particles of another simulation, followed again by this library, and the two compared figure by figure.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <scifi/geometry/mice.hpp>
#include <scifi/io/any_geometry.hpp>
#include <scifi/io/csv.hpp>
#include <scifi/particle_to_hit/transport.hpp>

#include "compare_simulation/quantities.hpp"
#include "run_program.hpp"

namespace {

struct options {
  std::string hits, truth, geometry;
  double field = 3.0;
  int repeat = 4;
  std::uint64_t seed = 1;
  bool check = false;
};

/// Events of a simulation by their number: what happened to their only particle.
using events = std::map<long, scifi::truth>;

/// Stops at a row of another tracker, or of a plane that does not exist.
void check_plane(const scifi::csv_reader& rows, const scifi::detector& where, int tracker, const scifi::channel_id& id) {
  if (id.tracker != tracker) rows.fail("tracker", std::to_string(id.tracker) + " is not " + std::to_string(tracker) + ": one tracker is compared");
  if (where.find_plane(id) == nullptr)
    rows.fail("plane", "there is no plane " + std::to_string(id.plane) + " in station " + std::to_string(id.station) + " of tracker " + std::to_string(tracker));
}

/// The tracker of the first crossing.
const scifi::tracker& tracker_of(const options& o, const scifi::detector& where) {
  scifi::csv_reader truth(o.truth, {"tracker"});
  if (!truth.next_row()) throw std::invalid_argument("--truth: no particle crosses a plane");
  const int id = truth.whole_number<int>(0);
  const scifi::tracker* t = where.find(id);
  if (t == nullptr) truth.fail("tracker", "there is no tracker " + std::to_string(id));
  return *t;
}

events read(const options& o, const scifi::any_geometry& geometry, int tracker) {
  events out;
  scifi::csv_reader truth(o.truth, {"event", "track", "pdg", "tracker", "station", "plane", "x_mm", "y_mm", "z_mm", "px_MeV", "py_MeV", "pz_MeV"});
  while (truth.next_row()) {
    scifi::truth& of = out[truth.whole_number<long>(0)];
    scifi::crossing c{truth.whole_number<int>(1), truth.whole_number<int>(2), truth.whole_number<int>(3), truth.whole_number<int>(4), truth.whole_number<int>(5),
                      {truth.number(6), truth.number(7), truth.number(8)}, {truth.number(9), truth.number(10), truth.number(11)}};
    check_plane(truth, geometry.detector, tracker, {c.tracker, c.station, c.plane, 0});
    if (c.momentum.z() == 0.0) truth.fail("pz_MeV", "a crossing needs a momentum along z");
    if (!of.crossings.empty() && of.crossings.front().particle != c.particle) truth.fail("track", "there is a second particle in this event; one each is compared");
    of.crossings.push_back(c);
  }
  scifi::csv_reader hits(o.hits, {"event", "track", "parent", "pdg", "tracker", "station", "plane", "fibre", "edep_MeV"});
  while (hits.next_row()) {
    scifi::hit h;
    h.particle = hits.whole_number<int>(1);
    h.parent = hits.whole_number<int>(2);
    h.pdg_id = hits.whole_number<int>(3);
    h.fibre = hits.whole_number<int>(7);
    h.id = {hits.whole_number<int>(4), hits.whole_number<int>(5), hits.whole_number<int>(6), scifi::channel_of_fibre(geometry.fibre, h.fibre)};
    check_plane(hits, geometry.detector, tracker, h.id);
    h.edep = hits.number(8);
    out[hits.whole_number<long>(0)].hits.push_back(h);
  }
  std::erase_if(out, [](const auto& event) { return event.second.crossings.empty(); });
  return out;
}

/// Follows the particles of `theirs` again, each from just before its first crossing.
void simulate(const events& theirs, const scifi::tracker& t, const scifi::fibre_doublet& fibre, const options& o, scifi::compare::quantities& out) {
  constexpr double before = 1.0;  // mm
  scifi::transport_settings settings;
  settings.field = o.field * scifi::units::tesla;
  settings.doublet = fibre;
  const scifi::transport follow(t, settings, scifi::coulomb_scattering{}, scifi::collision_loss{});
  scifi::truth made;
  for (int turn = 0; turn < o.repeat; ++turn) {
    for (const auto& [number, event] : theirs) {
      const scifi::crossing& first = event.crossings.front();
      const auto hypothesis = scifi::particle_from_pdg(first.pdg_id);
      if (!hypothesis) continue;
      scifi::moving_particle m{*hypothesis, first.position, first.momentum, 0.0};
      scifi::helix_step(m, first.momentum.z() > 0.0 ? -before : before, settings.field);
      scifi::random_stream random(o.seed, static_cast<std::uint64_t>(number), 0, static_cast<std::uint32_t>(turn));
      made.clear();
      made.last_particle = first.particle;
      follow(m, first.particle, random, made);
      out.add(number, made);
    }
  }
}

bool run(const options& o) {
  const scifi::any_geometry geometry = o.geometry.empty() ? scifi::any_geometry{scifi::mice::trackers(), {}, {}, {}, {}} : scifi::read_any_geometry(o.geometry);
  const scifi::tracker& t = tracker_of(o, geometry.detector);
  const events theirs = read(o, geometry, t.id);

  scifi::compare::quantities reference(t, o.field * scifi::units::tesla), own(t, o.field * scifi::units::tesla);
  for (const auto& [number, event] : theirs) reference.add(number, event);
  simulate(theirs, t, geometry.fibre, o, own);

  fmt::print("{} particles of {}, each followed {} times\n\n", theirs.size(), o.truth, o.repeat);
  fmt::print("{:<60} {:>10} {:>10} {:>7} {:>7}  {}\n", "", "own", "reference", "ratio", "error", "limit");
  bool all_close = true;
  const double core = reference.angle_over_highland.of(scifi::compare::core_width).value;
  for (const scifi::compare::line& l : scifi::compare::table(core)) {
    const scifi::compare::figure a = l.of(own);
    const scifi::compare::figure b = l.of(reference);
    if (!(a.value > 0.0) || !(b.value > 0.0)) {
      fmt::print("{:<60} {:>10.5f} {:>10.5f}\n", l.name, a.value, b.value);
      continue;
    }
    const double ratio = a.value / b.value;
    const double error = ratio * std::hypot(a.error / a.value, b.error / b.value);
    // A figure is outside when statistics cannot explain it.
    constexpr double sure = 2.0;
    const bool close = l.limit <= 0.0 || std::abs(ratio - 1.0) <= l.limit + sure * error;
    all_close = all_close && close;
    fmt::print("{:<60} {:>10.5f} {:>10.5f} {:>7.3f} {:>7.3f}  {}{}\n", l.name, a.value, b.value, ratio, error,
               l.limit > 0.0 ? fmt::format("{:.0f} %", 100.0 * l.limit) : "", close ? "" : "  OUTSIDE");
  }
  return all_close;
}

}  // namespace

int main(int argc, char** argv) {
  constexpr int apart = 1;
  options o;
  CLI::App app{"Compares this library's simulation with another one: the same particles through the same tracker."};
  app.add_option("--hits", o.hits, "the other simulation's energy deposits: event,track,parent,pdg,tracker,station,plane,fibre,edep_MeV")->required();
  app.add_option("--truth", o.truth, "its crossings: event,track,pdg,tracker,station,plane,x_mm,y_mm,z_mm,px_MeV,py_MeV,pz_MeV")->required();
  app.add_option("--field", o.field, "uniform field along z of the tracker frame, tesla")->capture_default_str();
  app.add_option("--repeat", o.repeat, "how often each particle is followed")->check(CLI::Range(1, 1000))->capture_default_str();
  app.add_option("--seed", o.seed, "seed")->capture_default_str();
  app.add_option("--geometry", o.geometry, "geometry in JSON or MiceModules; the MICE trackers unless given");
  app.add_flag("--check", o.check, "exit with 1 when a figure is further off than its limit and two statistical errors");
  bool all_close = true;
  const int status = run_program("scifi-compare-simulation", app, argc, argv, [&] { all_close = run(o); });
  return status == 0 && o.check && !all_close ? apart : status;
}
