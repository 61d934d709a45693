// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <scifi/arc/arc_fit.hpp>
#include <scifi/arc/chord_scan.hpp>
#include <scifi/arc/look_ahead.hpp>
#include <scifi/arc/point_grid.hpp>
#include <scifi/event/candidate.hpp>
#include <scifi/event/space_point.hpp>
#include <scifi/space_point_to_candidate/search_setting.hpp>
#include <scifi/space_point_to_candidate/seed.hpp>
#include <scifi/space_point_to_candidate/track_finder_options.hpp>

namespace scifi {

/// Working memory of the search.
struct search_buffers {
  std::vector<std::vector<int>> points;  // free space points per station
  std::vector<point_grid> grids;         // the same by place, filled when first asked
  std::vector<arc_point> arc_points;     // every space point
  std::vector<char> dim;                 // and which of them are no brighter than thermal noise is
  std::vector<double> chi2;              // and that of their crossing
  std::vector<char> cluster_used;
  std::vector<candidate> found;
  double largest_variance = 0.0;         // of the free points
  chord_scan scan;
};

/// The combination of space points that a search has in hand, and what can be asked of it: its fit, where it goes on, whether it makes a candidate.
struct search_trial {
  const search_setting& where;
  std::span<const space_point> space_points;
  search_buffers& work;  ///< `arc_points` and `cluster_used` filled by the caller
  int fits_left = where.options.max_arc_fits;
  long looks_left = where.options.max_looks;
  inline_vector<int, max_stations> stations{};  ///< chosen, numbers in order of growing z
  inline_vector<int, max_stations> chosen{};    ///< space points in the first of them

  [[nodiscard]] bool bent() const { return where.options.field != 0.0; }
  [[nodiscard]] bool complete() const { return fits_left > 0 && looks_left > 0; }
  [[nodiscard]] std::size_t station(std::size_t level) const { return static_cast<std::size_t>(stations[level]); }
  [[nodiscard]] const std::vector<int>& list(std::size_t level) const { return work.points[station(level)]; }
  [[nodiscard]] const point_grid& grid(std::size_t level) {
    point_grid& g = work.grids[station(level)];
    if (g.empty()) g.fill(list(level), work.arc_points);
    return g;
  }
  [[nodiscard]] const arc_point& arc(int point) const { return work.arc_points[static_cast<std::size_t>(point)]; }
  [[nodiscard]] const space_point& point(int i) const { return space_points[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const chord_turn& turn(std::size_t level) const { return where.turn(station(level - 2), station(level - 1), station(level)); }

  /// The points whose clusters are free, of those that `wanted` keeps.
  template <class Wanted>
  void collect(const Wanted& wanted) {
    for (auto& of_station : work.points) of_station.clear();
    work.largest_variance = 0.0;
    work.dim.resize(space_points.size());
    work.chi2.resize(space_points.size());
    for (std::size_t i = 0; i < space_points.size(); ++i) {
      const space_point& p = space_points[i];
      work.dim[i] = p.npe < where.options.dim_light * static_cast<double>(p.clusters.size());
      work.chi2[i] = p.chi2;
      if (p.tracker != where.id || !wanted(p)) continue;
      // A point with one cluster taken may be where two tracks cross; with more it belongs to the other.
      if (std::count_if(p.clusters.begin(), p.clusters.end(), [&](int c) { return work.cluster_used[static_cast<std::size_t>(c)] != 0; }) > 1) continue;
      const auto at = std::find(where.stations.begin(), where.stations.end(), p.station);
      if (at == where.stations.end()) continue;
      work.points[static_cast<std::size_t>(at - where.stations.begin())].push_back(static_cast<int>(i));
      work.largest_variance = std::max(work.largest_variance, work.arc_points[i].variance);
    }
    work.grids.resize(work.points.size());
    for (point_grid& g : work.grids) g.clear();
    work.found.clear();
  }

  [[nodiscard]] bool too_steep(const arc_point& a, const arc_point& b) const {
    const double reach = where.options.largest_slope * (b.z - a.z) + 5.0 * std::sqrt(a.variance + b.variance);
    return !(norm(b.position - a.position) <= reach * reach);
  }

  [[nodiscard]] bool dim(int i) const { return work.dim[static_cast<std::size_t>(i)] != 0; }
  [[nodiscard]] double chi2(int i) const { return work.chi2[static_cast<std::size_t>(i)]; }
  [[nodiscard]] int dim_points() const {
    return static_cast<int>(std::count_if(chosen.begin(), chosen.end(), [this](int i) { return dim(i); }));
  }

  [[nodiscard]] double scattering(std::size_t level, double w, double t2) const {
    return where.scattering.slope_variance(station(level), expected_momentum(where.options, w, t2), t2);
  }

  /// Gauss-Newton in the curvature from w through the chosen points.
  [[nodiscard]] arc_fit refine(double w, int iterations) {
    arc_fit fit = pass(w, 0.0);
    if (!bent()) return fit;
    for (int i = 0; i < iterations; ++i) {
      const double step = fit.curvature_step();
      const double limit = 0.5 * std::abs(where.options.prior.typical * where.options.field);
      fit = pass(fit.curvature() + std::clamp(step, -limit, limit), norm(fit.slope()));
      if (step * step < 0.01 * fit.curvature_variance()) break;
    }
    return fit;
  }

  /// The first and the last chord of the chosen points, three or more.
  [[nodiscard]] chord_pair chords(double w) const {
    const std::size_t n = chosen.size();
    const double scale = where.scattering.of_momentum(expected_inverse_momentum(where.options, w));
    chord_pair seen{arc(chosen[0]), arc(chosen[1]), arc(chosen[n - 2]), arc(chosen[n - 1]), n == 3, 0.0, scale * where.scattering.of_station(station(n - 1))};
    for (std::size_t i = 1; i + 1 < n; ++i) seen.kinks += scale * where.scattering.of_station(station(i));
    return seen;
  }

  /// `action(point, squared distance in units of its variance)` for the points of the next station that may belong to a track of this curvature.
  template <class Action>
  void each_ahead(const chord_pair& seen, double w, double limit, const Action& action) {
    const std::size_t level = chosen.size();
    const outlook next(seen, turn(level), w);
    const auto look_at = [&](int i) {
      --looks_left;
      if (!complete()) return;
      const double distance2 = next.distance2(arc(i));
      if (!(distance2 > limit)) action(i, distance2);
    };
    const planar<double> reach = std::sqrt(limit) * next.reach(work.largest_variance);
    constexpr std::size_t few = 8;  // points that are looked at faster than they are sorted by place
    if (list(level).size() > few && std::isfinite(reach.x + reach.y)) grid(level).near(next.place(), reach, look_at);
    else
      for (const int i : list(level)) look_at(i);
  }

  /// Makes the chosen points a candidate if they pass.
  void finish(const arc_fit& fit, double largest_chi2_per_ndf, double largest_total) {
    const track_finder_options& o = where.options;
    const int ndf = 2 * static_cast<int>(chosen.size()) - (bent() ? 5 : 4);
    if (!(fit.chi2() <= largest_chi2_per_ndf * ndf) || !(norm(fit.slope()) <= o.largest_slope * o.largest_slope)) return;
    if (bent() && std::abs(fit.curvature() / o.field) > 1.2 / o.smallest_pz) return;
    candidate c;
    c.tracker = where.id;
    c.shape = bent() ? track_shape::helix : track_shape::line;
    c.space_points = chosen;
    c.z = fit.z();
    c.chi2 = fit.chi2();
    c.ndf = ndf;
    for (const int i : chosen) {
      c.chi2 += point(i).chi2;
      c.ndf += static_cast<int>(point(i).clusters.size()) - 2;
    }
    if (!(c.chi2 <= largest_total)) return;
    c.seed = bent() ? seed_of_helix(fit, o.field) : seed_of_line(fit, where.travel * o.line_charge / o.line_momentum);
    // The same points by another hypothesis: keep the better.
    if (!work.found.empty() && std::equal(c.space_points.begin(), c.space_points.end(), work.found.back().space_points.begin(), work.found.back().space_points.end())) {
      if (c.chi2 < work.found.back().chi2) work.found.back() = c;
      return;
    }
    work.found.push_back(c);
  }

  /// One pass over the chosen points with the curvature given.
  [[nodiscard]] arc_fit pass(double w, double t2) {
    --fits_left;
    const double p = expected_momentum(where.options, w, t2);
    arc_fit fit(arc(chosen[0]), prior(w), w);
    for (std::size_t i = 1; i < chosen.size(); ++i) {
      const arc_point& next = arc(chosen[i]);
      fit.fly(next.z, where.scattering.slope_variance(station(i - 1), p, t2));
      fit.take(next);
    }
    return fit;
  }

 private:
  [[nodiscard]] arc_prior prior(double w) const {
    const track_finder_options& o = where.options;
    arc_prior p;
    p.slope_variance = 0.25 * o.largest_slope * o.largest_slope;
    if (bent()) {
      p.curvature = std::copysign(o.prior.typical * o.field, w);
      p.curvature_variance = o.prior.spread * o.prior.spread * o.field * o.field;
    }
    return p;
  }
};

}  // namespace scifi
