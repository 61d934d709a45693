// SPDX-License-Identifier: MPL-2.0
// scifi-simulate: particles of a beam through the trackers, fibre by fibre, written as digits and truth in CSV.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>

#include <scifi/geometry/mice.hpp>
#include <scifi/hit_to_digit/digitiser.hpp>
#include <scifi/io/any_geometry.hpp>
#include <scifi/io/atomic_file.hpp>
#include <scifi/io/channel_list_reader.hpp>
#include <scifi/particle_to_hit/transport.hpp>

#include "conditions/stored_conditions.hpp"
#include "field/chosen_field.hpp"
#include "simulate/beam.hpp"
#include "simulate/chosen_flight.hpp"
#include "simulate/make_event.hpp"
#include "simulate/tables.hpp"
#include "interruption.hpp"
#include "run_program.hpp"

namespace {

namespace simulate = scifi::simulate;

struct options {
  stored_conditions stored;
  long events = 1000;
  bool events_given = false;
  std::string tracker = "both";
  std::uint64_t seed = 1;
  std::string output = "simulated";
  chosen_field field;
  std::vector<double> pz{100.0, 280.0};
  std::vector<double> pt{0.0, 90.0};
  double radius = 110.0;
  std::string particle = "mu+";
  std::string beam = "flat";
  std::string particles;
  double emittance = 6.0, beta = 400.0, alpha = 0.0, canonical = 0.0;
  std::vector<double> momentum{200.0, 10.0};
  bool no_decays = false;
  int tracks_per_event = 1;
  double noise_rate = 0.015;
  double dead_share = 0.0;
  std::string dead_channels;
  std::string geometry;
  std::string scattering = "coulomb";
  std::string energy_loss = "collisions";
  bool hits = false;
  int threads = 0;
};

using simulate::follow;

template <class Scattering>
follow with_scattering(const scifi::tracker& t, const scifi::transport_settings& settings, const options& o, Scattering scattering) {
  const simulate::chosen_flight flight(o.field.in(t));
  if (o.energy_loss == "collisions") return scifi::transport(t, settings, scattering, scifi::collision_loss{}, flight);
  if (o.energy_loss == "mean") return scifi::transport(t, settings, scattering, scifi::fixed_loss<scifi::mean_energy_loss>{}, flight);
  return scifi::transport(t, settings, scattering, scifi::fixed_loss<scifi::no_energy_loss>{}, flight);
}

follow make_transport(const scifi::tracker& t, const scifi::transport_settings& settings, const options& o) {
  if (o.scattering == "coulomb") return with_scattering(t, settings, o, scifi::coulomb_scattering{});
  if (o.scattering == "highland") return with_scattering(t, settings, o, scifi::gaussian_scattering<scifi::highland_scattering>{});
  return with_scattering(t, settings, o, scifi::gaussian_scattering<scifi::no_scattering>{});
}

simulate::beam beam_of(const options& o, const scifi::detector& where) {
  simulate::beam out;
  const auto species = scifi::particle_from_name(o.particle);
  if (!species) throw std::invalid_argument("--particle: '" + o.particle + "' is not known; try mu+, mu-, pi+, pi-, e+, e- or p");
  out.tracks_per_event = o.tracks_per_event;
  out.field = [&o](const scifi::tracker& t) { return o.field.in(t).mean; };
  if (!o.particles.empty()) {
    out.from = simulate::beam::kind::file;
    out.file = scifi::read_particles(o.particles, where);
  } else if (o.beam == "gaussian") {
    out.from = simulate::beam::kind::gaussian;
    out.gaussian = {*species, o.emittance, o.beta, o.alpha, o.canonical, o.momentum[0], o.momentum[1]};
    out.gaussian.check();
  } else {
    out.flat.hypothesis = *species;
    out.flat.pz_min = o.pz[0];
    out.flat.pz_max = o.pz[1];
    out.flat.pt_min = o.pt[0];
    out.flat.pt_max = o.pt[1];
    out.flat.radius = o.radius;
    out.flat.check();
  }
  return out;
}

void run(options& o) {
  const auto start = std::chrono::steady_clock::now();
  o.stored.fill_in(o.geometry, scifi::condition_kind::geometry);
  scifi::detector detector = scifi::mice::trackers();
  scifi::transport_settings settings;
  std::optional<scifi::any_geometry> geometry;
  if (!o.geometry.empty()) {
    geometry = scifi::read_any_geometry(o.geometry);
    for (const std::string& note : geometry->notes) fmt::print(stderr, "note: {}\n", note);
    detector = geometry->detector;
    settings.doublet = geometry->fibre;
  }
  o.field.resolve(detector, geometry ? &*geometry : nullptr);

  const simulate::beam beam = beam_of(o, detector);
  long events = o.events;
  if (beam.from == simulate::beam::kind::file) {
    const auto in_file = static_cast<long>(beam.file.size());
    events = o.events_given ? std::min(o.events, in_file) : in_file;
  }

  settings.decays = !o.no_decays;
  std::vector<simulate::line> lines;
  for (const scifi::tracker& t : detector.trackers)
    if (o.tracker == "both" || o.tracker == std::to_string(t.id)) {
      settings.field = o.field.in(t).mean;
      lines.push_back({&t, make_transport(t, settings, o)});
    }
  if (lines.empty()) throw std::invalid_argument("--tracker: the geometry has no tracker " + o.tracker);

  scifi::digitiser<> digitise;
  digitise.noise.rate = o.noise_rate;
  digitise.calibration.seed = o.seed;
  digitise.dead = o.dead_channels.empty() ? scifi::drawn_dead_channels(detector, o.dead_share, o.seed)
                                          : scifi::dead_channels(scifi::read_channel_list(o.dead_channels, detector));

  interruption::listen();
  std::deque<scifi::atomic_file> files;
  const std::size_t written = o.hits ? simulate::tables : simulate::hits;
  for (std::size_t i = 0; i < written; ++i) files.emplace_back(o.output + "_" + simulate::names[i] + ".csv").write(simulate::headers[i]);

  std::optional<tbb::global_control> limit;
  if (o.threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(o.threads));

  // Events are made in parallel and written block by block, in order.
  constexpr long block = 1024;
  std::vector<simulate::simulated_event> made(static_cast<std::size_t>(std::min(block, std::max(events, 1L))));
  simulate::totals sum;
  for (long first = 0; first < events; first += block) {
    interruption::throw_if_received();
    const long count = std::min(block, events - first);
    tbb::parallel_for(0L, count, [&](long i) { simulate::make_event(lines, beam, digitise, {o.seed, o.hits}, first + i, made[static_cast<std::size_t>(i)]); });
    for (long i = 0; i < count; ++i) {
      const simulate::simulated_event& e = made[static_cast<std::size_t>(i)];
      for (std::size_t k = 0; k < written; ++k) files[k].write(e.written[k]);
      sum.add(e.sum);
    }
  }
  for (scifi::atomic_file& file : files) file.commit();

  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double per_event = 1.0 / static_cast<double>(std::max(events, 1L) * static_cast<long>(lines.size()));
  fmt::print("events              {:>10}   (seed {}, field {}, {})\n", events, o.seed, o.field.description(), o.particles.empty() ? o.particle : o.particles);
  if (!o.stored.store().empty()) fmt::print("geometry            {}\n", o.stored.origin(o.geometry));
  fmt::print("particles           {:>10}   {} of them through all planes\n", sum.particles, sum.crossed);
  fmt::print("plane crossings     {:>10}\n", sum.crossings);
  fmt::print("hits in fibre cores {:>10}\n", sum.hits);
  if (digitise.dead.size() > 0) fmt::print("dead channels       {:>10}\n", digitise.dead.size());
  fmt::print("digits              {:>10}   {:.2f} in a tracker and event\n", sum.digits, static_cast<double>(sum.digits) * per_event);
  fmt::print("time                {:>10.2f} s, {:.0f} events/s\n", seconds, static_cast<double>(events) / seconds);
  const auto microseconds = [events](std::chrono::steady_clock::duration d) { return std::chrono::duration<double, std::micro>(d).count() / static_cast<double>(std::max(events, 1L)); };
  fmt::print("time per event      flight {:.1f} us, digitisation {:.1f} us, on one thread\n", microseconds(sum.flight), microseconds(sum.digitisation));
  std::string names;
  for (const scifi::atomic_file& file : files) names += (names.empty() ? "" : ", ") + file.name();
  fmt::print("written             {}\n", names);
}

}  // namespace

int main(int argc, char** argv) {
  options o;
  CLI::App app{"Simulates particles in scintillating-fibre trackers: PREFIX_digits.csv and PREFIX_truth.csv. Units: mm, ns, MeV, MeV/c, tesla."};
  const CLI::Option* const events = app.add_option("--events", o.events, "number of events; with --particles all of the file unless given")->check(CLI::Range(1L, 1000000000L))->capture_default_str();
  app.add_option("--tracker", o.tracker, "0 (upstream), 1 (downstream), or both, each with its own tracks in the same events")->capture_default_str();
  app.add_option("--seed", o.seed, "seed; the same seed gives the same events for any number of threads")->capture_default_str();
  app.add_option("--output", o.output, "prefix of the files that are written")->capture_default_str();
  o.field.offer(app);
  app.add_option("--beam", o.beam, "flat or gaussian")->check(CLI::IsMember({"flat", "gaussian"}))->capture_default_str();
  app.add_option("--particles", o.particles, "particles from a table instead: event,tracker,pdg,x_mm,y_mm,z_mm,t_ns,px_MeV,py_MeV,pz_MeV in the tracker's frame");
  app.add_option("--emittance", o.emittance, "Gaussian beam: normalised transverse emittance, mm")->capture_default_str();
  app.add_option("--beta", o.beta, "Gaussian beam: beta function 30 mm before the tracker, mm")->capture_default_str();
  app.add_option("--alpha", o.alpha, "Gaussian beam: alpha there, positive for a converging beam")->capture_default_str();
  app.add_option("--canonical", o.canonical, "Gaussian beam: canonical angular momentum over 2 m emittance")->capture_default_str();
  app.add_option("--momentum", o.momentum, "Gaussian beam: mean and standard deviation of pz, MeV/c")->expected(2)->capture_default_str();
  app.add_option("--pz", o.pz, "flat beam: longitudinal momentum, flat between two bounds, MeV/c")->expected(2)->capture_default_str();
  app.add_option("--pt", o.pt, "flat beam: transverse momentum, flat between two bounds, MeV/c, kept below pz/2")->expected(2)->capture_default_str();
  app.add_option("--radius", o.radius, "flat beam: particles start in a disc of this radius, 30 mm before the tracker, mm")->capture_default_str();
  app.add_option("--particle", o.particle, "mu+, mu-, pi+, pi-, e+, e-, p")->capture_default_str();
  app.add_option("--tracks-per-event", o.tracks_per_event, "particles in each simulated tracker of an event")->check(CLI::Range(0, 100000))->capture_default_str();
  app.add_option("--noise-rate", o.noise_rate, "chance of thermal photo-electrons, per channel and event")->check(CLI::Range(0.0, 0.999))->capture_default_str();
  CLI::Option* const share = app.add_option("--dead-share", o.dead_share, "chance of a channel to be dead, drawn with the seed")->check(CLI::Range(0.0, 1.0))->capture_default_str();
  app.add_option("--dead-channels", o.dead_channels, "dead channels from a table instead: tracker,station,plane,channel")->excludes(share);
  app.add_option("--geometry", o.geometry, "geometry in JSON (.json) or MiceModules (.dat); the MICE trackers unless given");
  o.stored.offer(app);
  app.add_option("--scattering", o.scattering, "coulomb (with tails), highland (Gaussian) or none")->check(CLI::IsMember({"coulomb", "highland", "none"}))->capture_default_str();
  app.add_option("--energy-loss", o.energy_loss, "collisions (fluctuating), mean or none")->check(CLI::IsMember({"collisions", "mean", "none"}))->capture_default_str();
  app.add_flag("--hits", o.hits, "write PREFIX_hits.csv, _sources.csv and _particles.csv too: energy in each fibre core, particles behind each digit, where they come from");
  app.add_flag("--no-decays", o.no_decays, "muons and pions do not decay");
  app.add_option("--threads", o.threads, "number of threads; 0: all cores")->check(CLI::Range(0, 1024))->capture_default_str();
  return run_program("scifi-simulate", app, argc, argv, [&] {
    o.events_given = events->count() > 0;
    run(o);
  });
}
