// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <scifi/hit_to_digit/digitiser.hpp>
#include <scifi/particle_to_hit/transport.hpp>

#include "simulate/beam.hpp"
#include "simulate/tables.hpp"

namespace scifi::simulate {

using follow = std::function<flight_end(const moving_particle&, int, random_stream&, truth&)>;

/// One tracker with what is needed to simulate it.
struct line {
  const tracker* where;
  follow fly;
};

struct totals {
  long particles = 0, crossed = 0, crossings = 0, hits = 0, digits = 0;
  std::chrono::steady_clock::duration flight{}, digitisation{};  ///< on one thread
  void add(const totals& more) {
    particles += more.particles;
    crossed += more.crossed;
    crossings += more.crossings;
    hits += more.hits;
    digits += more.digits;
    flight += more.flight;
    digitisation += more.digitisation;
  }
};

struct run_settings {
  std::uint64_t seed = 1;
  bool history = false;  ///< hits, sources and particles too
};

/// Everything of one event; kept for the next one to reuse its memory.
struct simulated_event {
  std::vector<std::vector<moving_particle>> beams;  // of each tracker
  truth real;
  std::vector<raw_digit> made;
  rows written;
  totals sum;
};

/// Simulates event i of a run: a function of the seed and the event's number alone.
inline void make_event(const std::vector<line>& lines, const beam& from, const digitiser<>& digitise, const run_settings& run, long i, simulated_event& out) {
  for (std::string& text : out.written) text.clear();
  out.sum = {};
  const long number = from.number(i);
  const auto event = static_cast<std::uint64_t>(number);
  // Particles of the beam are numbered first, through all trackers, then what they make.
  out.beams.resize(lines.size());
  int last_particle = 0;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    out.beams[l].clear();
    from.fill(i, *lines[l].where, run.seed, last_particle, out.beams[l]);
    last_particle += static_cast<int>(out.beams[l].size());
  }
  int index = 0;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const tracker& t = *lines[l].where;
    out.real.clear();
    out.real.last_particle = last_particle;
    const auto start = std::chrono::steady_clock::now();
    for (const moving_particle& particle : out.beams[l]) {
      ++index;
      random_stream random(run.seed, event, stage::flight, static_cast<std::uint32_t>(index));
      out.sum.crossed += lines[l].fly(particle, index, random, out.real) == flight_end::crossed;
    }
    const auto flown = std::chrono::steady_clock::now();
    last_particle = out.real.last_particle;
    random_stream for_digits(run.seed, event, stage::digitisation, static_cast<std::uint32_t>(t.id));
    digitise(t, out.real.hits, for_digits, out.made);
    out.sum.flight += flown - start;
    out.sum.digitisation += std::chrono::steady_clock::now() - flown;
    add_digits(number, out.made, out.written);
    add_crossings(number, out.real, out.written);
    if (run.history) add_history(number, t.id, out.real, out.made, out.written);
    out.sum.particles += static_cast<long>(out.beams[l].size());
    out.sum.crossings += static_cast<long>(out.real.crossings.size());
    out.sum.hits += static_cast<long>(out.real.hits.size());
    out.sum.digits += static_cast<long>(out.made.size());
  }
}

}  // namespace scifi::simulate
