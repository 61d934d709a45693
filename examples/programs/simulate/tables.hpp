// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cstddef>
#include <iterator>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <scifi/event/raw_digit.hpp>
#include <scifi/event/truth.hpp>
#include <scifi/hit_to_digit/digit_sources.hpp>
#include <scifi/io/digit_writer.hpp>

namespace scifi::simulate {

/// The files that a run writes. `sources` leads from the id of a digit (tspc) to the particles whose energy is in it.
enum table : std::size_t { digits, truths, hits, sources, particles, tables };

inline constexpr std::array<const char*, tables> names{"digits", "truth", "hits", "sources", "particles"};
inline constexpr std::array<std::string_view, tables> headers{
    digit_columns, "event,track,pdg,tracker,station,plane,x_mm,y_mm,z_mm,px_MeV,py_MeV,pz_MeV\n",
    "event,track,parent,pdg,tracker,station,plane,fibre,edep_MeV,t_ns,x_mm,y_mm,z_mm,px_MeV,py_MeV,pz_MeV\n", "event,tspc,track,parent,pdg,hits,edep_MeV\n",
    "event,track,parent,pdg,origin,tracker,t_ns,x_mm,y_mm,z_mm,px_MeV,py_MeV,pz_MeV\n"};

/// Rows of each table.
using rows = std::array<std::string, tables>;

template <class... Values>
void add_row(std::string& out, fmt::format_string<Values...> format, Values&&... values) {
  fmt::format_to(std::back_inserter(out), format, std::forward<Values>(values)...);
}

inline void add_digits(long event, std::span<const raw_digit> made, rows& out) {
  for (const raw_digit& d : made) append_digit(out[digits], event, d);
}

inline void add_crossings(long event, const truth& real, rows& out) {
  for (const crossing& c : real.crossings)
    add_row(out[truths], "{},{},{},{},{},{},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f}\n", event, c.particle, c.pdg_id, c.tracker, c.station, c.plane,
            c.position.x(), c.position.y(), c.position.z(), c.momentum.x(), c.momentum.y(), c.momentum.z());
}

/// What lies behind the digits of tracker `tracker`: hits, the particles of each digit, and where all particles come from.
inline void add_history(long event, int tracker, const truth& real, std::span<const raw_digit> made, rows& out) {
  for (const hit& h : real.hits)
    add_row(out[hits], "{},{},{},{},{},{},{},{},{:.6f},{:.4f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f}\n", event, h.particle, h.parent, h.pdg_id, h.id.tracker,
            h.id.station, h.id.plane, h.fibre, h.edep, h.t, h.position.x(), h.position.y(), h.position.z(), h.momentum.x(), h.momentum.y(), h.momentum.z());
  constexpr std::array origins{"beam", "knocked_on", "decay"};
  for (const simulated_particle& p : real.particles)
    add_row(out[particles], "{},{},{},{},{},{},{:.4f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f}\n", event, p.particle, p.parent, p.pdg_id,
            origins[static_cast<std::size_t>(p.origin)], tracker, p.t, p.position.x(), p.position.y(), p.position.z(), p.momentum.x(), p.momentum.y(), p.momentum.z());

  struct share {
    int parent = 0, pdg = 0, hits = 0;
    double edep = 0.0;
  };
  const digit_sources behind(real.hits);
  for (const raw_digit& d : made) {
    std::map<int, share> by_particle;
    for (const hit& h : behind.of(d.id)) {
      share& s = by_particle[h.particle];
      s = {h.parent, h.pdg_id, s.hits + 1, s.edep + h.edep};
    }
    for (const auto& [particle, s] : by_particle)
      add_row(out[sources], "{},{},{},{},{},{},{:.6f}\n", event, tspc(d.id), particle, s.parent, s.pdg, s.hits, s.edep);
  }
}

}  // namespace scifi::simulate
