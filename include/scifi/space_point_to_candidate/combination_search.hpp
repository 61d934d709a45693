// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <scifi/event/candidate.hpp>
#include <scifi/event/space_point.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/space_point_to_candidate/arc_fit.hpp>
#include <scifi/space_point_to_candidate/chord_hypotheses.hpp>
#include <scifi/space_point_to_candidate/seed.hpp>
#include <scifi/space_point_to_candidate/station_scattering.hpp>
#include <scifi/space_point_to_candidate/track_finder_options.hpp>

namespace scifi {

/// Working memory of the search.
struct search_buffers {
  std::vector<std::vector<int>> points;  // free space points per station
  std::vector<arc_point> arc_points;     // every space point
  std::vector<char> cluster_used;
  std::vector<candidate> found;
};

/// What a search needs to know of a tracker and of the tracks in it.
struct search_setting {
  int id = 0;      ///< of the tracker
  int travel = 1;  ///< direction of the beam in z
  std::vector<int> stations;  ///< ids in order of growing z
  station_scattering scattering;
  track_finder_options options;
};

/// One search for combinations of space points through a given number of stations of a tracker; see track_finder for the method.
class combination_search {
 public:
  /// All three outlive the search; `work.arc_points` and `work.cluster_used` are filled by the caller.
  combination_search(const search_setting& setting, std::span<const space_point> space_points, search_buffers& memory)
      : where_(setting),
        options_(setting.options),
        scattering_(setting.scattering),
        points_(space_points),
        work_(memory),
        budget_(setting.options.max_arc_fits),
        looks_(setting.options.max_looks) {}

  /// Fills `work.found` with the candidates through `size` stations, from points whose clusters are free, with tight or wide cuts.
  void operator()(int size, bool tight) {
    gate_ = tight ? options_.tight_gate : options_.gate;
    chi2_per_ndf_ = tight ? options_.tight_chi2_per_ndf : options_.chi2_per_ndf;
    point_chi2_ = tight ? options_.tight_point_chi2 : std::numeric_limits<double>::infinity();
    collect_free();
    work_.found.clear();
    choose_stations(0, size);
  }

  /// False once the bound on the number of arc fits or of looks was reached.
  [[nodiscard]] bool complete() const { return budget_ > 0 && looks_ > 0; }

 private:
  void collect_free() {
    for (auto& list : work_.points) list.clear();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const space_point& p = points_[i];
      if (p.tracker != where_.id || p.chi2 > point_chi2_) continue;
      // A point with one cluster taken may be where two tracks cross; with more it belongs to the other.
      if (std::count_if(p.clusters.begin(), p.clusters.end(), [&](int c) { return work_.cluster_used[static_cast<std::size_t>(c)] != 0; }) > 1) continue;
      const auto at = std::find(where_.stations.begin(), where_.stations.end(), p.station);
      if (at != where_.stations.end()) work_.points[static_cast<std::size_t>(at - where_.stations.begin())].push_back(static_cast<int>(i));
    }
  }

  /// Every choice of `size` stations, none without points.
  void choose_stations(std::size_t first, int size) {
    if (size == 0) {
      start();
      return;
    }
    for (std::size_t i = first; i < where_.stations.size() && stations_.size() < stations_.capacity(); ++i) {
      if (work_.points[i].empty()) continue;
      stations_.push_back(static_cast<int>(i));
      choose_stations(i + 1, size - 1);
      stations_.pop_back();
    }
  }

  [[nodiscard]] const std::vector<int>& list(std::size_t level) const { return work_.points[static_cast<std::size_t>(stations_[level])]; }
  [[nodiscard]] const arc_point& arc(int point) const { return work_.arc_points[static_cast<std::size_t>(point)]; }

  [[nodiscard]] arc_prior prior(double w) const {
    const track_finder_options& o = options_;
    arc_prior p;
    p.slope_variance = 0.25 * o.largest_slope * o.largest_slope;
    if (bent()) {
      p.curvature = std::copysign(o.prior.typical * o.field, w);
      p.curvature_variance = o.prior.spread * o.prior.spread * o.field * o.field;
    }
    return p;
  }

  /// One pass over the chosen points with the curvature given.
  [[nodiscard]] arc_fit pass(double w, double t2) {
    --budget_;
    const double p = expected_momentum(options_, w, t2);
    arc_fit fit(arc(chosen_[0]), prior(w), w);
    for (std::size_t i = 1; i < chosen_.size(); ++i) {
      const arc_point& point = arc(chosen_[i]);
      fit.fly(point.z, scattering_.slope_variance(static_cast<std::size_t>(stations_[i - 1]), p, t2));
      fit.take(point);
    }
    return fit;
  }

  /// Gauss-Newton in the curvature from w.
  [[nodiscard]] arc_fit refine(double w, int iterations) {
    arc_fit fit = pass(w, 0.0);
    if (!bent()) return fit;
    for (int i = 0; i < iterations; ++i) {
      const double step = fit.curvature_step();
      const double limit = 0.5 * std::abs(options_.prior.typical * options_.field);
      fit = pass(fit.curvature() + std::clamp(step, -limit, limit), norm(fit.slope()));
      if (step * step < 0.01 * fit.curvature_variance()) break;
    }
    return fit;
  }

  [[nodiscard]] bool too_steep(const arc_point& a, const arc_point& b) const {
    const double reach = options_.largest_slope * (b.z - a.z) + 5.0 * std::sqrt(a.variance + b.variance);
    return !(norm(b.position - a.position) <= reach * reach);
  }

  /// No brighter than thermal noise is.
  [[nodiscard]] bool dim(int point) const {
    const space_point& p = points_[static_cast<std::size_t>(point)];
    return p.npe < options_.dim_light * static_cast<double>(p.clusters.size());
  }
  [[nodiscard]] int dim_points() const {
    return static_cast<int>(std::count_if(chosen_.begin(), chosen_.end(), [this](int point) { return dim(point); }));
  }

  /// Every triple of points in the first three stations.
  void start() {
    const auto station = [this](std::size_t level) { return static_cast<std::size_t>(stations_[level]); };
    const chord_hypotheses hypotheses(options_, scattering_, station(0), station(1), arc(list(0).front()).z, arc(list(1).front()).z, arc(list(2).front()).z, gate_);
    for (const int a : list(0)) {
      for (const int b : list(1)) {
        if (--looks_ <= 0) return;
        if (too_steep(arc(a), arc(b))) continue;
        for (const int c : list(2)) {
          --looks_;
          if (!complete()) return;
          chosen_ = {a, b, c};
          if (too_steep(arc(b), arc(c)) || dim_points() > options_.max_dim_points) continue;
          if (!bent()) follow(pass(0.0, 0.0));
          else
            for (const curvature_hypothesis& h : hypotheses(arc(a), arc(b), arc(c))) {
              chosen_ = {a, b, c};
              follow(refine(h.curvature, h.iterations));
            }
        }
      }
    }
  }

  /// Extends the chosen points through the remaining stations.
  void follow(const arc_fit& fit) {
    const std::size_t level = chosen_.size();
    const double ndf = 2.0 * static_cast<double>(level) - (bent() ? 5.0 : 4.0);
    if (!(fit.chi2_after_step() <= chi2_per_ndf_ * ndf + gate_)) return;
    if (level == stations_.size()) {
      finish(fit);
      return;
    }
    const double t2 = norm(fit.slope());
    const double scatter = scattering_.slope_variance(static_cast<std::size_t>(stations_[level - 1]), expected_momentum(options_, fit.curvature(), t2), t2);
    const bool dim_allowed = dim_points() < options_.max_dim_points;
    arc_fit ahead = fit;
    bool flown = false;
    for (const int next : list(level)) {
      --looks_;
      if (!complete()) return;
      if (!dim_allowed && dim(next)) continue;
      if (!flown || ahead.z() != arc(next).z) {  // the points of a station share z, doublets aside
        ahead = fit;
        ahead.fly(arc(next).z, scatter);
        flown = true;
      }
      if (!(ahead.distance2(arc(next)) <= gate_)) continue;
      chosen_.push_back(next);
      follow(refine(fit.curvature(), 2));
      chosen_.pop_back();
    }
  }

  void finish(const arc_fit& fit) {
    const track_finder_options& o = options_;
    const int ndf = 2 * static_cast<int>(chosen_.size()) - (bent() ? 5 : 4);
    if (!(fit.chi2() <= chi2_per_ndf_ * ndf) || !(norm(fit.slope()) <= o.largest_slope * o.largest_slope)) return;
    if (bent() && std::abs(fit.curvature() / o.field) > 1.2 / o.smallest_pz) return;
    candidate c;
    c.tracker = where_.id;
    c.shape = bent() ? track_shape::helix : track_shape::line;
    c.space_points = chosen_;
    c.z = fit.z();
    c.chi2 = fit.chi2();
    c.ndf = ndf;
    for (const int point : chosen_) {
      const space_point& p = points_[static_cast<std::size_t>(point)];
      c.chi2 += p.chi2;
      c.ndf += static_cast<int>(p.clusters.size()) - 2;
    }
    c.seed = bent() ? seed_of_helix(fit, o.field) : seed_of_line(fit, where_.travel * o.line_charge / o.line_momentum);
    // The same points by another hypothesis: keep the better.
    if (!work_.found.empty() && std::equal(c.space_points.begin(), c.space_points.end(), work_.found.back().space_points.begin(), work_.found.back().space_points.end())) {
      if (c.chi2 < work_.found.back().chi2) work_.found.back() = c;
      return;
    }
    work_.found.push_back(c);
  }

  [[nodiscard]] bool bent() const { return options_.field != 0.0; }

  const search_setting& where_;
  const track_finder_options& options_;
  const station_scattering& scattering_;
  std::span<const space_point> points_;
  search_buffers& work_;
  int budget_;  // arc fits left
  long looks_;
  double gate_ = 0.0;
  double chi2_per_ndf_ = 0.0;
  double point_chi2_ = 0.0;
  inline_vector<int, max_stations> stations_;  // chosen, indices into where.stations
  inline_vector<int, max_stations> chosen_;    // space points
};

}  // namespace scifi
