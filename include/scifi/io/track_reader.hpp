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
#include <scifi/kalman/status.hpp>

namespace scifi {

/// Reads tracks as `append_tracks` writes them (track_columns), plain or gzip. The detector must outlive the reader.
class track_reader {
 public:
  /// More tracks in an event than this are taken for a mistake.
  static constexpr int most_tracks = 100000;

  /// Throws input_error.
  track_reader(const std::filesystem::path& path, const detector& d)
      : rows_(path, {"tracker", "track", "model", "charge", "stations", "planes", "chi2", "ndf", "p_value", "x_mm", "y_mm", "z_mm", "px_MeV", "py_MeV", "pz_MeV",
                     "sigma_x_mm", "sigma_y_mm", "sigma_px_MeV", "sigma_py_MeV", "sigma_pz_MeV"}),
        detector_(d) {}

  /// Number of the next event, or event_rows::no_more.
  [[nodiscard]] long next_event() const { return rows_.next_event(); }

  /// Sets `out.tracks` to those of event `number`, each at the index that its column `track` gives; a track that has no row, for its fit had stopped, has a
  /// status that is not ok. The covariance is diagonal: the table has no more. Empties `out.tracks` when the next event is a later one. Throws input_error,
  /// with file, line and column, for whatever does not fit.
  void read(long number, event& out) {
    out.tracks.clear();
    rows_.read(number, [&](const csv_reader& row) { add(row, out); });
  }

 private:
  enum columns : std::size_t { event_column, tracker, index, model, charge, stations, planes, chi2, ndf, p_value, x, y, z, px, py, pz, sigma_x, sigma_y, sigma_px, sigma_py, sigma_pz };

  void add(const csv_reader& row, event& out) const {
    const int place = row.whole_number<int>(index);
    if (place < static_cast<int>(out.tracks.size()))
      row.fail("track", std::to_string(place) + (place < 0 ? " is negative" : ": the tracks of an event stand in the order of their numbers, each once"));
    if (place >= most_tracks) row.fail("track", std::to_string(place) + ": no event has so many tracks");
    track absent;
    absent.reference = {vector<double, 5>::Zero(), matrix<double, 5, 5>::Zero()};
    absent.status.why = kalman::reason::not_finite;
    out.tracks.resize(static_cast<std::size_t>(place), absent);

    track t;
    t.tracker = row.whole_number<int>(tracker);
    if (detector_.find(t.tracker) == nullptr) row.fail("tracker", "there is no tracker " + std::to_string(t.tracker));
    if (row.text(model) == "line") t.shape = track_shape::line;
    else if (row.text(model) != "helix") row.fail("model", in_quotes(row.text(model)) + " is neither 'helix' nor 'line'");
    t.charge = row.whole_number<int>(charge);
    t.stations = row.whole_number<int>(stations);
    t.planes = row.whole_number<int>(planes);
    t.chi2 = row.number(chi2);
    t.ndf = row.whole_number<int>(ndf);
    t.p_value = row.number_or_nan(p_value);
    if (t.ndf > 0 && !(t.p_value >= 0.0 && t.p_value <= 1.0)) row.fail("p_value", in_quotes(row.text(p_value)) + " is outside 0 .. 1");
    t.z = row.number(z);
    const vector<double, 5> mean{row.number(x), row.number(y), row.number(px), row.number(py), row.number(pz)};
    const vector<double, 5> sigmas{row.number_or_nan(sigma_x), row.number_or_nan(sigma_y), row.number_or_nan(sigma_px), row.number_or_nan(sigma_py),
                                   row.number_or_nan(sigma_pz)};
    if (mean[4] == 0.0) row.fail("pz_MeV", "a track has a momentum along z");
    for (int i = 0; i < 5; ++i)
      if (sigmas[i] < 0.0) row.fail(row.column_name(sigma_x + static_cast<std::size_t>(i)), "a standard deviation is not negative");
    t.reference = kalman::uncorrelated(mean, sigmas);
    out.tracks.push_back(t);
  }

  event_rows rows_;
  const detector& detector_;
};

}  // namespace scifi
