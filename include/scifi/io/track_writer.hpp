// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

#include <scifi/event/event.hpp>
#include <scifi/io/fixed_point.hpp>
#include <scifi/kalman/estimate.hpp>
#include <scifi/track_model/helix_state.hpp>
#include <scifi/track_model/slope_state.hpp>

namespace scifi {

/// Header line of the table of tracks: one row a track, its parameters and standard deviations at the reference surface, tracker frame.
inline constexpr std::string_view track_columns =
    "event,tracker,track,model,charge,stations,planes,chi2,ndf,p_value,x_mm,y_mm,z_mm,px_MeV,py_MeV,pz_MeV,"
    "sigma_x_mm,sigma_y_mm,sigma_px_MeV,sigma_py_MeV,sigma_pz_MeV\n";

/// Header line of the table of track points: one row a plane of a track, the smoothed state there, tracker frame.
inline constexpr std::string_view track_point_columns =
    "event,tracker,track,station,plane,z_mm,x_mm,y_mm,tx,ty,q_over_pz,sigma_x_mm,sigma_y_mm,sigma_tx,sigma_ty,sigma_q_over_pz,"
    "cluster_channel,residual_mm,pull,chi2,outlier\n";

namespace detail {

/// A row of a table under way.
class csv_row {
 public:
  explicit csv_row(std::string& out) : out_(out) {}
  template <std::integral Integer>
  csv_row& integer(Integer value) {
    separate();
    append_integer(out_, value);
    return *this;
  }
  csv_row& fixed(double value, int decimals) {
    separate();
    append_fixed(out_, value, decimals);
    return *this;
  }
  csv_row& text(std::string_view value) {
    separate();
    out_ += value;
    return *this;
  }
  void end() { out_ += '\n'; }

 private:
  void separate() {
    if (!first_) out_ += ',';
    first_ = false;
  }
  std::string& out_;
  bool first_ = true;
};

inline constexpr int mm_decimals = 5;
inline constexpr int momentum_decimals = 5;  // MeV/c
inline constexpr int slope_decimals = 8;
inline constexpr int curvature_decimals = 11;  // q/pz, e/(MeV/c)
inline constexpr int statistic_decimals = 5;   // chi2, pull
inline constexpr int probability_decimals = 7;

}  // namespace detail

/// Appends the rows of an event's tracks under `track_columns`, in their order. The column `track` is the index in `event.tracks`;
/// a track whose fit stopped (status not ok) has no row.
inline void append_tracks(std::string& out, const event& e) {
  using namespace detail;
  for (std::size_t i = 0; i < e.tracks.size(); ++i) {
    const track& t = e.tracks[i];
    if (!t.status.ok()) continue;
    csv_row row(out);
    row.integer(e.number).integer(t.tracker).integer(i).text(t.shape == track_shape::helix ? "helix" : "line");
    row.integer(t.charge).integer(t.stations).integer(t.planes);
    row.fixed(t.chi2, statistic_decimals).integer(t.ndf).fixed(t.p_value, probability_decimals);
    using c = momentum_state;
    const auto& at = t.reference;
    row.fixed(at.mean[c::x], mm_decimals).fixed(at.mean[c::y], mm_decimals).fixed(t.z, mm_decimals);
    for (const auto p : {c::px, c::py, c::pz}) row.fixed(at.mean[p], momentum_decimals);
    for (const auto x : {c::x, c::y}) row.fixed(kalman::sigma(at, x), mm_decimals);
    for (const auto p : {c::px, c::py, c::pz}) row.fixed(kalman::sigma(at, p), momentum_decimals);
    row.end();
  }
}

/// Appends the rows of the points of an event's tracks under `track_point_columns`; `cluster_channel` is "nan" where no cluster is.
inline void append_track_points(std::string& out, const event& e) {
  using namespace detail;
  for (std::size_t i = 0; i < e.tracks.size(); ++i) {
    const track& t = e.tracks[i];
    if (!t.status.ok()) continue;
    const auto first = static_cast<std::size_t>(t.first_point);
    for (std::size_t k = first; k < first + static_cast<std::size_t>(t.points); ++k) {
      const track_point& p = e.track_points[k];
      const double channel = p.cluster >= 0 ? e.clusters[static_cast<std::size_t>(p.cluster)].channel : std::numeric_limits<double>::quiet_NaN();
      csv_row row(out);
      row.integer(e.number).integer(t.tracker).integer(i).integer(p.station).integer(p.plane).fixed(p.z, mm_decimals);
      const auto& at = p.smoothed;
      using c = slope_state;
      for (const auto x : {c::x, c::y}) row.fixed(at.mean[x], mm_decimals);
      for (const auto slope : {c::tx, c::ty}) row.fixed(at.mean[slope], slope_decimals);
      row.fixed(at.mean[c::q_over_pz], curvature_decimals);
      for (const auto x : {c::x, c::y}) row.fixed(kalman::sigma(at, x), mm_decimals);
      for (const auto slope : {c::tx, c::ty}) row.fixed(kalman::sigma(at, slope), slope_decimals);
      row.fixed(kalman::sigma(at, c::q_over_pz), curvature_decimals);
      row.fixed(channel, 1).fixed(p.residual, mm_decimals).fixed(p.pull, statistic_decimals).fixed(p.chi2, statistic_decimals);
      row.integer(p.outlier ? 1 : 0);
      row.end();
    }
  }
}

}  // namespace scifi
