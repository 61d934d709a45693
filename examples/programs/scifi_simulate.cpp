// SPDX-License-Identifier: MPL-2.0
// scifi-simulate: particles from a gun through the trackers, fibre by fibre, written as digits and truth in CSV.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>

#include <scifi/geometry/mice.hpp>
#include <scifi/hit_to_digit/digitiser.hpp>
#include <scifi/io/atomic_file.hpp>
#include <scifi/io/geometry_json.hpp>
#include <scifi/particle_to_hit/gun.hpp>
#include <scifi/particle_to_hit/transport.hpp>

namespace {

struct options {
  long events = 1000;
  std::string tracker = "both";
  std::uint64_t seed = 1;
  std::string output = "simulated";
  double field = 3.0;
  std::vector<double> pz{100.0, 280.0};
  std::vector<double> pt{0.0, 90.0};
  double radius = 110.0;
  std::string particle = "mu+";
  int tracks_per_event = 1;
  double noise_rate = 0.015;
  std::string geometry;
  std::string scattering = "coulomb";
  std::string energy_loss = "collisions";
  bool hits = false;
  int threads = 0;
};

/// The steps of an event that draw random numbers, each from a stream of its own.
enum stage : std::uint32_t { gun, flight, digitisation };

using follow = std::function<scifi::flight_end(const scifi::moving_particle&, int, scifi::random_stream&, scifi::truth&)>;

template <class Scattering>
follow with_scattering(const scifi::tracker& t, const scifi::transport_settings& settings, const std::string& loss, Scattering scattering) {
  if (loss == "collisions") return scifi::transport(t, settings, scattering, scifi::collision_loss{});
  if (loss == "mean") return scifi::transport(t, settings, scattering, scifi::fixed_loss<scifi::mean_energy_loss>{});
  return scifi::transport(t, settings, scattering, scifi::fixed_loss<scifi::no_energy_loss>{});
}

follow make_transport(const scifi::tracker& t, const scifi::transport_settings& settings, const options& o) {
  if (o.scattering == "coulomb") return with_scattering(t, settings, o.energy_loss, scifi::coulomb_scattering{});
  if (o.scattering == "highland") return with_scattering(t, settings, o.energy_loss, scifi::gaussian_scattering<scifi::highland_scattering>{});
  return with_scattering(t, settings, o.energy_loss, scifi::gaussian_scattering<scifi::no_scattering>{});
}

/// One tracker with what is needed to simulate it.
struct line {
  const scifi::tracker* tracker;
  follow transport;
};

struct totals {
  long particles = 0, crossed = 0, crossings = 0, hits = 0, digits = 0;
  void add(const totals& more) {
    particles += more.particles;
    crossed += more.crossed;
    crossings += more.crossings;
    hits += more.hits;
    digits += more.digits;
  }
};

/// Everything of one event; kept for the next one to reuse its memory.
struct simulated_event {
  scifi::truth truth;
  std::vector<scifi::raw_digit> digits;
  std::string truth_rows, hit_rows, digit_rows;
  totals sum;
};

template <class... Values>
void add_row(std::string& out, fmt::format_string<Values...> format, Values&&... values) {
  fmt::format_to(std::back_inserter(out), format, std::forward<Values>(values)...);
}

void write_truth(const scifi::truth& truth, long number, bool with_hits, simulated_event& out) {
  for (const scifi::crossing& c : truth.crossings)
    add_row(out.truth_rows, "{},{},{},{},{},{},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f}\n", number, c.particle, c.pdg_id, c.tracker, c.station, c.plane,
            c.position.x(), c.position.y(), c.position.z(), c.momentum.x(), c.momentum.y(), c.momentum.z());
  if (!with_hits) return;
  for (const scifi::hit& h : truth.hits)
    add_row(out.hit_rows, "{},{},{},{},{},{},{:.6f},{:.4f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f}\n", number, h.particle, h.id.tracker, h.id.station,
            h.id.plane, h.fibre, h.edep, h.t, h.position.x(), h.position.y(), h.position.z(), h.momentum.x(), h.momentum.y(), h.momentum.z());
}

void simulate(const std::vector<line>& lines, const scifi::flat_beam& beam, const scifi::digitiser<>& digitise, const options& o, long number,
              simulated_event& out) {
  out.truth_rows.clear();
  out.hit_rows.clear();
  out.digit_rows.clear();
  out.sum = {};
  const auto event = static_cast<std::uint64_t>(number);
  std::uint32_t particle = 0;
  for (const line& l : lines) {
    out.truth.clear();
    for (int i = 0; i < o.tracks_per_event; ++i) {
      ++particle;
      scifi::random_stream for_gun(o.seed, event, stage::gun, particle);
      scifi::random_stream for_flight(o.seed, event, stage::flight, particle);
      const scifi::flight_end end = l.transport(beam.shoot(*l.tracker, for_gun), static_cast<int>(particle), for_flight, out.truth);
      ++out.sum.particles;
      out.sum.crossed += end == scifi::flight_end::crossed;
    }
    scifi::random_stream for_digits(o.seed, event, stage::digitisation, static_cast<std::uint32_t>(l.tracker->id));
    digitise(*l.tracker, out.truth.hits, for_digits, out.digits);
    write_truth(out.truth, number, o.hits, out);
    for (const scifi::raw_digit& d : out.digits)
      add_row(out.digit_rows, "{},{},{},{},{},{},{:.3f}\n", number, d.id.tracker, d.id.station, d.id.plane, d.id.channel, d.adc, d.npe);
    out.sum.crossings += static_cast<long>(out.truth.crossings.size());
    out.sum.hits += static_cast<long>(out.truth.hits.size());
    out.sum.digits += static_cast<long>(out.digits.size());
  }
}

void run(const options& o) {
  const auto start = std::chrono::steady_clock::now();
  const scifi::detector detector = o.geometry.empty() ? scifi::mice::trackers() : scifi::read_geometry(o.geometry);

  scifi::flat_beam beam;
  const auto species = scifi::particle_from_name(o.particle);
  if (!species) throw std::invalid_argument("--particle: '" + o.particle + "' is not known; try mu+, mu-, pi+, pi-, e+, e- or p");
  beam.hypothesis = *species;
  beam.pz_min = o.pz[0];
  beam.pz_max = o.pz[1];
  beam.pt_min = o.pt[0];
  beam.pt_max = o.pt[1];
  beam.radius = o.radius;
  beam.check();

  scifi::transport_settings settings;
  settings.field = o.field * scifi::units::tesla;
  std::vector<line> lines;
  for (const scifi::tracker& t : detector.trackers)
    if (o.tracker == "both" || o.tracker == std::to_string(t.id)) lines.push_back({&t, make_transport(t, settings, o)});
  if (lines.empty()) throw std::invalid_argument("--tracker: the geometry has no tracker " + o.tracker);

  scifi::digitiser<> digitise;
  digitise.noise.rate = o.noise_rate;
  digitise.calibration.seed = o.seed;

  scifi::atomic_file digits(o.output + "_digits.csv");
  scifi::atomic_file truth(o.output + "_truth.csv");
  std::optional<scifi::atomic_file> hits;
  digits.write("event,tracker,station,plane,channel,adc,npe\n");
  truth.write("event,track,pdg,tracker,station,plane,x_mm,y_mm,z_mm,px_MeV,py_MeV,pz_MeV\n");
  if (o.hits) {
    hits.emplace(o.output + "_hits.csv");
    hits->write("event,track,tracker,station,plane,fibre,edep_MeV,t_ns,x_mm,y_mm,z_mm,px_MeV,py_MeV,pz_MeV\n");
  }

  std::optional<tbb::global_control> limit;
  if (o.threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(o.threads));

  // Events are made in parallel and written block by block, in order.
  constexpr long block = 1024;
  std::vector<simulated_event> made(static_cast<std::size_t>(std::min(block, o.events)));
  totals sum;
  for (long first = 0; first < o.events; first += block) {
    const long count = std::min(block, o.events - first);
    tbb::parallel_for(0L, count, [&](long i) { simulate(lines, beam, digitise, o, first + i, made[static_cast<std::size_t>(i)]); });
    for (long i = 0; i < count; ++i) {
      const simulated_event& e = made[static_cast<std::size_t>(i)];
      digits.write(e.digit_rows);
      truth.write(e.truth_rows);
      if (hits) hits->write(e.hit_rows);
      sum.add(e.sum);
    }
  }
  digits.commit();
  truth.commit();
  if (hits) hits->commit();

  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double per_event = 1.0 / static_cast<double>(o.events * static_cast<long>(lines.size()));
  fmt::print("events              {:>10}   (seed {}, field {} T, {})\n", o.events, o.seed, o.field, beam.hypothesis.name);
  fmt::print("particles           {:>10}   {} of them through all planes\n", sum.particles, sum.crossed);
  fmt::print("plane crossings     {:>10}\n", sum.crossings);
  fmt::print("hits in fibre cores {:>10}\n", sum.hits);
  fmt::print("digits              {:>10}   {:.2f} in a tracker and event\n", sum.digits, static_cast<double>(sum.digits) * per_event);
  fmt::print("time                {:>10.2f} s, {:.0f} events/s\n", seconds, static_cast<double>(o.events) / seconds);
  fmt::print("written             {}, {}{}\n", digits.name(), truth.name(), hits ? ", " + hits->name() : "");
}

}  // namespace

int main(int argc, char** argv) {
  constexpr int given_wrongly = 2;
  constexpr int not_written = 3;
  options o;
  CLI::App app{"Simulates particles in scintillating-fibre trackers: PREFIX_digits.csv and PREFIX_truth.csv. Units: mm, ns, MeV, MeV/c, tesla."};
  app.add_option("--events", o.events, "number of events")->check(CLI::Range(1L, 1000000000L))->capture_default_str();
  app.add_option("--tracker", o.tracker, "0 (upstream), 1 (downstream), or both, each with its own tracks in the same events")->capture_default_str();
  app.add_option("--seed", o.seed, "seed; the same seed gives the same events for any number of threads")->capture_default_str();
  app.add_option("--output", o.output, "prefix of the files that are written")->capture_default_str();
  app.add_option("--field", o.field, "uniform field along z of the tracker frame, tesla")->check(CLI::Range(-100.0, 100.0))->capture_default_str();
  app.add_option("--pz", o.pz, "longitudinal momentum, flat between two bounds, MeV/c")->expected(2)->capture_default_str();
  app.add_option("--pt", o.pt, "transverse momentum, flat between two bounds, MeV/c, kept below pz/2")->expected(2)->capture_default_str();
  app.add_option("--radius", o.radius, "particles start in a disc of this radius, 30 mm before the tracker, mm")->capture_default_str();
  app.add_option("--particle", o.particle, "mu+, mu-, pi+, pi-, e+, e-, p")->capture_default_str();
  app.add_option("--tracks-per-event", o.tracks_per_event, "particles in each simulated tracker of an event")->check(CLI::Range(0, 100000))->capture_default_str();
  app.add_option("--noise-rate", o.noise_rate, "chance of thermal photo-electrons, per channel and event")->check(CLI::Range(0.0, 0.999))->capture_default_str();
  app.add_option("--geometry", o.geometry, "geometry in JSON; the MICE trackers unless given");
  app.add_option("--scattering", o.scattering, "coulomb (with tails), highland (Gaussian) or none")->check(CLI::IsMember({"coulomb", "highland", "none"}))->capture_default_str();
  app.add_option("--energy-loss", o.energy_loss, "collisions (fluctuating), mean or none")->check(CLI::IsMember({"collisions", "mean", "none"}))->capture_default_str();
  app.add_flag("--hits", o.hits, "write PREFIX_hits.csv too: the energy left in each fibre core");
  app.add_option("--threads", o.threads, "number of threads; 0: all cores")->check(CLI::Range(0, 1024))->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : given_wrongly;
  }
  try {
    run(o);
  } catch (const scifi::input_error& e) {
    fmt::print(stderr, "scifi-simulate: {}\n", e.what());
    return given_wrongly;
  } catch (const std::invalid_argument& e) {
    fmt::print(stderr, "scifi-simulate: {}\n", e.what());
    return given_wrongly;
  } catch (const std::exception& e) {
    fmt::print(stderr, "scifi-simulate: {}\n", e.what());
    return not_written;
  }
  return 0;
}
