// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <scifi/event/truth.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/io/event_rows.hpp>

namespace scifi {

/// Reads the crossings of a simulation, plain or gzip: columns event, track, pdg, tracker, station, plane, x_mm, y_mm, z_mm, px_MeV, py_MeV, pz_MeV,
/// found by name; others are ignored. The detector must outlive the reader.
class truth_reader {
 public:
  /// Throws input_error.
  truth_reader(const std::filesystem::path& path, const detector& d)
      : rows_(path, {"track", "pdg", "tracker", "station", "plane", "x_mm", "y_mm", "z_mm", "px_MeV", "py_MeV", "pz_MeV"}), detector_(d) {}

  /// Number of the next event, or event_rows::no_more.
  [[nodiscard]] long next_event() const { return rows_.next_event(); }

  /// Sets `out` to the crossings of event `number`; empties it when the next event is a later one. Throws input_error, with file, line and column, for
  /// whatever does not fit: planes that do not exist and particles with pz = 0 among it.
  void read(long number, std::vector<crossing>& out) {
    enum columns : std::size_t { event_column, track, pdg, tracker, station, plane, x, y, z, px, py, pz };
    out.clear();
    rows_.read(number, [&](const csv_reader& row) {
      crossing c{row.whole_number<int>(track), row.whole_number<int>(pdg), row.whole_number<int>(tracker), row.whole_number<int>(station), row.whole_number<int>(plane),
                 {row.number(x), row.number(y), row.number(z)}, {row.number(px), row.number(py), row.number(pz)}};
      if (detector_.find(c.tracker) == nullptr) row.fail("tracker", "there is no tracker " + std::to_string(c.tracker));
      if (detector_.find_plane({c.tracker, c.station, c.plane, 0}) == nullptr)
        row.fail("plane", "there is no plane " + std::to_string(c.plane) + " in station " + std::to_string(c.station) + " of tracker " + std::to_string(c.tracker));
      if (c.momentum.z() == 0.0) row.fail("pz_MeV", "a particle that crosses a plane has a momentum along z");
      out.push_back(c);
    });
  }

 private:
  event_rows rows_;
  const detector& detector_;
};

}  // namespace scifi
