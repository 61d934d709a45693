// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <scifi/space_point_to_candidate/chord_hypotheses.hpp>
#include <scifi/space_point_to_candidate/search_trial.hpp>
#include <scifi/space_point_to_candidate/sure_search.hpp>

namespace scifi {

/// One search for combinations of space points through a given number of stations of a tracker; see track_finder for the method.
class combination_search {
 public:
  /// All three outlive the search; `work.arc_points` and `work.cluster_used` are filled by the caller.
  combination_search(const search_setting& setting, std::span<const space_point> space_points, search_buffers& work) : trial_{setting, space_points, work} {}

  /// Fills `work.found` with the candidates through `size` stations, from points whose clusters are free, with tight or wide cuts.
  void operator()(int size, bool tight) {
    const track_finder_options& o = trial_.where.options;
    gate_ = tight ? o.tight_gate : o.gate;
    chi2_per_ndf_ = tight ? o.tight_chi2_per_ndf : o.chi2_per_ndf;
    const double point_chi2 = tight ? o.tight_point_chi2 : std::numeric_limits<double>::infinity();
    trial_.collect([point_chi2](const space_point& p) { return !(p.chi2 > point_chi2); });
    choose_stations(0, size);
  }

  /// Fills `work.found` with the candidates that sure_search finds where points crowd. Returns false, and does nothing, where they do not.
  bool sure(double chi2_per_ndf) { return sure_search(trial_)(chi2_per_ndf); }

  /// False once the bound on the number of arc fits or of looks was reached.
  [[nodiscard]] bool complete() const { return trial_.complete(); }

 private:
  /// Every choice of `size` stations, none without points.
  void choose_stations(std::size_t first, int size) {
    auto& stations = trial_.stations;
    if (size == 0) {
      start();
      return;
    }
    for (std::size_t i = first; i < trial_.where.stations.size() && stations.size() < stations.capacity(); ++i) {
      if (trial_.work.points[i].empty()) continue;
      stations.push_back(static_cast<int>(i));
      choose_stations(i + 1, size - 1);
      stations.pop_back();
    }
  }

  /// Every triple of points in the first three stations.
  void start() {
    search_trial& t = trial_;
    const chord_hypotheses hypotheses(t.where.options, t.where.scattering, t.station(0), t.station(1), t.turn(2), gate_);
    for (const int a : t.list(0)) {
      for (const int b : t.list(1)) {
        if (--t.looks_left <= 0) return;
        if (t.too_steep(t.arc(a), t.arc(b))) continue;
        for (const int c : t.list(2)) {
          --t.looks_left;
          if (!complete()) return;
          t.chosen = {a, b, c};
          if (t.too_steep(t.arc(b), t.arc(c)) || t.dim_points() > t.where.options.max_dim_points) continue;
          if (!t.bent()) follow(t.pass(0.0, 0.0));
          else
            for (const curvature_hypothesis& h : hypotheses(t.arc(a), t.arc(b), t.arc(c))) {
              --t.looks_left;
              t.chosen = {a, b, c};
              if (h.iterations > 1 || goes_on(h.curvature)) follow(t.refine(h.curvature, h.iterations));
            }
        }
      }
    }
  }

  /// How far ahead points are looked at: the whole chi2 that a candidate may have, twice, since hard scattering upstream moves the chords too.
  [[nodiscard]] double furthest() const { return 2.0 * chi2_per_ndf_ * (2.0 * static_cast<double>(trial_.stations.size()) - (trial_.bent() ? 5.0 : 4.0)); }

  /// Whether a point of the next station may belong to a track of this curvature through the chosen three: asked before the fit, which takes longer.
  [[nodiscard]] bool goes_on(double w) {
    search_trial& t = trial_;
    if (t.stations.size() == 3 || std::abs(w) > t.turn(3).largest()) return true;
    bool any = false;
    t.each_ahead(t.chords(w), w, furthest(), [&any](int, double) { any = true; });
    return any;
  }

  /// Extends the chosen points through the remaining stations.
  void follow(const arc_fit& fit) {
    search_trial& t = trial_;
    const track_finder_options& o = t.where.options;
    const std::size_t level = t.chosen.size();
    const double ndf_now = 2.0 * static_cast<double>(level) - (t.bent() ? 5.0 : 4.0);
    if (!(fit.chi2_after_step() <= chi2_per_ndf_ * ndf_now + gate_)) return;
    if (level == t.stations.size()) {
      t.finish(fit, chi2_per_ndf_, std::numeric_limits<double>::infinity());
      return;
    }
    const double t2 = norm(fit.slope());
    const double scatter = t.scattering(level - 1, fit.curvature(), t2);
    const bool dim_allowed = t.dim_points() < o.max_dim_points;
    arc_fit ahead = fit;
    bool flown = false;
    const auto try_point = [&](int next) {
      if (!dim_allowed && t.dim(next)) return;
      if (!flown || ahead.z() != t.arc(next).z) {  // the points of a station share z, doublets aside
        ahead = fit;
        ahead.fly(t.arc(next).z, scatter);
        flown = true;
      }
      if (!(ahead.distance2(t.arc(next)) <= gate_)) return;
      t.chosen.push_back(next);
      follow(t.refine(fit.curvature(), 2));
      t.chosen.pop_back();
    };
    const double w = fit.curvature();
    if (std::abs(w) <= t.turn(level).largest()) {
      t.each_ahead(t.chords(w), w, furthest(), [&try_point](int next, double) { try_point(next); });
      return;
    }
    for (const int next : t.list(level)) {
      --t.looks_left;
      if (!complete()) return;
      try_point(next);
    }
  }

  search_trial trial_;
  double gate_ = 0.0;
  double chi2_per_ndf_ = 0.0;
};

}  // namespace scifi
