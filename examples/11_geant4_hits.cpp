// SPDX-License-Identifier: MPL-2.0
// Hits of a Geant4 simulation, from CSV to tracks: 11_geant4_hits HITS.csv [tracker=1]. Without a file it writes one of its own first, with the
// simulation of this library in place of Geant4, so that it can be run and checked.
//
// A sensitive detector needs to write one line for each fibre core and particle: event,tracker,station,plane,fibre,edep_MeV (more columns may follow in
// any order). Fibre f of a plane is read by channel f / 7.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <scifi/chain/reconstruction.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/hit_to_digit/digitiser.hpp>
#include <scifi/io/csv.hpp>
#include <scifi/particle_to_hit/gun.hpp>
#include <scifi/particle_to_hit/transport.hpp>

using namespace scifi::literals;

// [hits]
struct hit_event {
  long number;
  std::vector<scifi::hit> hits;
};

/// Rows of an event stand together. What does not fit is a scifi::input_error that names file, line and column.
std::vector<hit_event> read_hits(const std::filesystem::path& path) {
  enum columns : std::size_t { event_column, tracker, station, plane, fibre, edep };
  scifi::csv_reader rows(path, {"event", "tracker", "station", "plane", "fibre", "edep_MeV"});
  const scifi::fibre_doublet doublet;
  std::vector<hit_event> out;
  while (rows.next_row()) {
    scifi::hit h;
    h.fibre = rows.whole_number<int>(fibre);
    h.id = {rows.whole_number<int>(tracker), rows.whole_number<int>(station), rows.whole_number<int>(plane), scifi::channel_of_fibre(doublet, h.fibre)};
    h.edep = rows.number(edep);
    if (h.fibre < 0) rows.fail("fibre", "fibres are counted from 0");
    if (h.edep < 0.0) rows.fail("edep_MeV", "an energy deposit must not be negative");
    const long number = rows.whole_number<long>(event_column);
    if (out.empty() || out.back().number != number) out.push_back({number, {}});
    out.back().hits.push_back(h);
  }
  return out;
}
// [hits]

/// What Geant4 would write; returns the number of muons that crossed the whole tracker.
std::size_t write_hits(const std::filesystem::path& path, const scifi::tracker& t, std::size_t muons) {
  scifi::transport_settings settings;
  settings.field = 3.0_T;
  const scifi::transport fly(t, settings);
  const scifi::flat_beam beam;
  std::ofstream file(path);
  std::size_t crossed = 0;
  file << "event,track,pdg,tracker,station,plane,fibre,edep_MeV\n";
  for (std::size_t i = 0; i < muons; ++i) {
    scifi::random_stream random(11, i, 0);
    scifi::truth truth;
    truth.last_particle = 1;
    if (fly(beam.shoot(t, random), 1, random, truth) == scifi::flight_end::crossed) ++crossed;
    for (const scifi::hit& h : truth.hits)
      file << i << ',' << h.particle << ',' << h.pdg_id << ',' << h.id.tracker << ',' << h.id.station << ',' << h.id.plane << ',' << h.fibre << ',' << h.edep << '\n';
  }
  return crossed;
}

int main(int argc, char** argv) try {
  const scifi::detector mice = scifi::mice::trackers();
  const int number = argc > 2 ? std::stoi(argv[2]) : scifi::mice::downstream;
  const scifi::tracker* t = mice.find(number);
  if (t == nullptr) throw std::invalid_argument("there is no tracker " + std::to_string(number));

  const bool own = argc < 2;
  const std::filesystem::path path = own ? std::filesystem::path("geant4_hits.csv") : std::filesystem::path(argv[1]);
  constexpr std::size_t muons = 300;
  const std::size_t crossed = own ? write_hits(path, *t, muons) : 0;

  // [chain]
  const scifi::digitiser digitise;
  scifi::reconstruction_options options;
  options.field = 3.0_T;
  const auto reconstruct = scifi::make_reconstruction(mice, options);

  scifi::event e;
  std::vector<scifi::raw_digit> read_out;
  std::size_t events = 0, tracks = 0;
  for (const hit_event& simulated : read_hits(path)) {
    scifi::random_stream random(1, static_cast<std::uint64_t>(simulated.number), 1);
    digitise(*t, simulated.hits, random, read_out);
    e.clear();
    e.number = simulated.number;
    for (const scifi::raw_digit& d : read_out) e.digits.push_back(d.seen());
    reconstruct(e);
    ++events;
    tracks += e.tracks.size();
  }
  // [chain]
  std::printf("%zu events, %zu tracks\n", events, tracks);
  if (own) std::filesystem::remove(path);
  return !own || (tracks >= crossed * 97 / 100 && tracks <= muons) ? 0 : 1;
} catch (const std::exception& problem) {
  std::fprintf(stderr, "%s\n", problem.what());
  return 2;
}
