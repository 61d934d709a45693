// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include <scifi/core/linalg.hpp>
#include <scifi/event/event.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/io/event_rows.hpp>
#include <scifi/kalman/estimate.hpp>

namespace scifi {

/// Reads track points as `append_track_points` writes them (track_point_columns), plain or gzip. The detector must outlive the reader.
class track_point_reader {
 public:
  /// Throws input_error.
  track_point_reader(const std::filesystem::path& path, const detector& d)
      : rows_(path, {"tracker", "track", "station", "plane", "z_mm", "x_mm", "y_mm", "tx", "ty", "q_over_pz", "sigma_x_mm", "sigma_y_mm", "sigma_tx", "sigma_ty",
                     "sigma_q_over_pz", "residual_mm", "pull", "chi2", "outlier"}),
        detector_(d) {}

  /// Number of the next event, or event_rows::no_more.
  [[nodiscard]] long next_event() const { return rows_.next_event(); }

  /// Gives the tracks that `out` already has for event `number` their points. Which cluster a point has is not told: its index stays -1. The covariance is
  /// diagonal. Throws input_error, with file, line and column, for whatever does not fit, a point of a track that is not there among it.
  void read(long number, event& out) {
    out.track_points.clear();
    rows_.read(number, [&](const csv_reader& row) { add(row, out); });
  }

 private:
  enum columns : std::size_t { event_column, tracker, index, station, plane, z, x, y, tx, ty, q_over_pz, sigma_x, sigma_y, sigma_tx, sigma_ty, sigma_q_over_pz, residual, pull, chi2, outlier };

  void add(const csv_reader& row, event& out) const {
    const int place = row.whole_number<int>(index);
    if (place < 0 || static_cast<std::size_t>(place) >= out.tracks.size() || !out.tracks[static_cast<std::size_t>(place)].status.ok())
      row.fail("track", "there is no track " + std::to_string(place) + " in event " + std::to_string(row.whole_number<long>(event_column)));
    track& of = out.tracks[static_cast<std::size_t>(place)];
    if (row.whole_number<int>(tracker) != of.tracker) row.fail("tracker", "the track is one of tracker " + std::to_string(of.tracker));
    if (of.points == 0) of.first_point = static_cast<int>(out.track_points.size());
    if (of.first_point + of.points != static_cast<int>(out.track_points.size())) row.fail("track", "the points of a track must stand together");

    track_point p;
    p.station = row.whole_number<int>(station);
    p.plane = row.whole_number<int>(plane);
    if (detector_.find_plane({of.tracker, p.station, p.plane, 0}) == nullptr)
      row.fail("plane", "there is no plane " + std::to_string(p.plane) + " in station " + std::to_string(p.station) + " of tracker " + std::to_string(of.tracker));
    p.z = row.number(z);
    const vector<double, 5> mean{row.number(x), row.number(tx), row.number(y), row.number(ty), row.number(q_over_pz)};
    const vector<double, 5> sigmas{row.number_or_nan(sigma_x), row.number_or_nan(sigma_tx), row.number_or_nan(sigma_y), row.number_or_nan(sigma_ty),
                                   row.number_or_nan(sigma_q_over_pz)};
    p.smoothed = kalman::uncorrelated(mean, sigmas);
    p.residual = row.number_or_nan(residual);
    p.pull = row.number_or_nan(pull);
    p.chi2 = row.number_or_nan(chi2);
    p.outlier = row.whole_number<int>(outlier) != 0;
    out.track_points.push_back(p);
    ++of.points;
  }

  event_rows rows_;
  const detector& detector_;
};

}  // namespace scifi
