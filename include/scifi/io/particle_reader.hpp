// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <scifi/geometry/tracker.hpp>
#include <scifi/io/csv.hpp>
#include <scifi/io/event_rows.hpp>
#include <scifi/particle_to_hit/moving_particle.hpp>

namespace scifi {

/// A particle of a beam file: where it starts, and in the frame of which tracker.
struct beam_particle {
  int tracker = 0;
  moving_particle start;
};

/// The particles of an event.
struct beam_event {
  long number = 0;
  std::vector<beam_particle> particles;
};

/// Reads a beam from a table, plain or gzip, such as another simulation writes: a header line, then the columns event, tracker, pdg, x_mm, y_mm, z_mm,
/// t_ns, px_MeV, py_MeV, pz_MeV, found by name; others are ignored. The frame is the tracker's. Particles of an event stand together and event numbers grow.
/// Throws input_error, with file, line and column, for whatever does not fit, an unknown tracker or pdg and pz = 0 among it.
[[nodiscard]] inline std::vector<beam_event> read_particles(const std::filesystem::path& path, const detector& d) {
  enum columns : std::size_t { event_column, tracker, pdg, x, y, z, t, px, py, pz };
  event_rows rows(path, {"tracker", "pdg", "x_mm", "y_mm", "z_mm", "t_ns", "px_MeV", "py_MeV", "pz_MeV"});
  std::vector<beam_event> out;
  while (rows.next_event() != event_rows::no_more) {
    out.push_back({rows.next_event(), {}});
    rows.read(out.back().number, [&](const csv_reader& row) {
      const int code = row.whole_number<int>(pdg);
      const auto hypothesis = particle_from_pdg(code);
      if (!hypothesis) row.fail("pdg", std::to_string(code) + " is not known; try 13, -13, 211, -211, 11, -11 or 2212");
      beam_particle p;
      p.tracker = row.whole_number<int>(tracker);
      if (d.find(p.tracker) == nullptr) row.fail("tracker", "there is no tracker " + std::to_string(p.tracker));
      p.start.hypothesis = *hypothesis;
      p.start.position = {row.number(x), row.number(y), row.number(z)};
      p.start.momentum = {row.number(px), row.number(py), row.number(pz)};
      p.start.t = row.number(t);
      if (p.start.momentum.z() == 0.0) row.fail("pz_MeV", "a particle needs a momentum along z");
      out.back().particles.push_back(p);
    });
  }
  return out;
}

}  // namespace scifi
