// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <scifi/space_point_to_candidate/search_trial.hpp>

namespace scifi {

/// The search for tracks that leave no doubt, where points crowd: through all stations, with all planes of each lit, the momentum as the prior has it, and a
/// small chi2 in all. What a combination has used up of that chi2 bounds every further step: the points' own, the deviation of the second chord's length, and the
/// distance from where the chords point. The fit comes last.
class sure_search {
 public:
  explicit sure_search(search_trial& in_hand) : trial_(in_hand) {}

  /// False, and nothing is done, unless the first three stations have more than `options.crowd` triples of such points.
  bool operator()(double chi2_per_ndf) {
    search_trial& t = trial_;
    const track_finder_options& o = t.where.options;
    const std::size_t stations = t.where.stations.size();
    if (!t.bent() || stations < 4 || stations > max_stations) return false;
    // Three lists with this many points in all have most triples when they are of the same length.
    if (std::pow(static_cast<double>(t.space_points.size()) / 3.0, 3.0) <= static_cast<double>(o.crowd)) return false;
    // Each point has two coordinates for the track and one degree of freedom of its own.
    total_ = chi2_per_ndf * (3.0 * static_cast<double>(stations) - 5.0);
    const double most = std::min(total_, o.tight_point_chi2);
    t.collect([most](const space_point& p) { return p.clusters.size() >= 3 && p.chi2 <= most; });
    t.stations.clear();
    for (std::size_t i = 0; i < stations; ++i) t.stations.push_back(static_cast<int>(i));
    double triples = 1.0;
    for (std::size_t i = 0; i < 3; ++i) triples *= static_cast<double>(t.list(i).size());
    const bool crowded = triples > static_cast<double>(o.crowd);
    if (crowded) search();
    t.stations.clear();
    return crowded;
  }

 private:
  void search() {
    search_trial& t = trial_;
    const track_finder_options& o = t.where.options;
    const double most = std::abs(o.field) * std::min(o.prior.typical + o.prior.spread, 1.0 / o.smallest_pz);
    chord_scan& scan = t.work.scan;
    const double kink = t.where.scattering.of_station(t.station(1)) * square(t.turn(2).step2());
    scan.prepare(t.turn(2), most, {1.0 / square(o.field), square(expected_inverse_momentum(o, 0.0)), kink, kink * t.where.scattering.mass2()});
    const double ratio = t.turn(2).longest_ratio();
    for (const int b : t.list(1)) {
      const arc_point& middle = t.arc(b);
      const double of_middle = t.chi2(b);
      scan.clear();
      double variance = 0.0;
      for (const int c : t.list(2)) {
        --t.looks_left;
        if (t.too_steep(middle, t.arc(c)) || of_middle + t.chi2(c) > total_) continue;
        scan.add(t.arc(c).position - middle.position, t.chi2(c), c);
        variance = std::max(variance, t.arc(c).variance);
      }
      scan.order();
      variance += middle.variance * square(1.0 + ratio);
      for (const int a : t.list(0)) {
        --t.looks_left;
        if (!t.complete()) return;
        const double left = total_ - of_middle - t.chi2(a);
        if (left < 0.0 || t.too_steep(t.arc(a), middle)) continue;
        const auto hits = scan(middle.position - t.arc(a).position, variance + t.arc(a).variance * square(ratio), left);
        t.looks_left -= scan.rounds() + static_cast<long>(hits.size());
        for (const chord_scan::hit& h : hits) {
          t.chosen = {a, b, h.point};
          if (t.dim_points() <= o.max_dim_points) extend(h.curvature, left - t.chi2(h.point) - h.chi2);
        }
      }
    }
  }

  /// Through the remaining stations with the chi2 that is left.
  void extend(double w, double left) {
    search_trial& t = trial_;
    const std::size_t level = t.chosen.size();
    if (level == t.stations.size()) {
      if (!t.complete()) return;
      t.finish(t.refine(w, 2), std::numeric_limits<double>::infinity(), total_);
      return;
    }
    const chord_pair seen = t.chords(w);
    const double better = level > 3 ? seen.curvature(w) : w;
    if (!(std::abs(better) <= t.turn(level).largest())) return;
    const bool dim_allowed = t.dim_points() < t.where.options.max_dim_points;
    t.each_ahead(seen, better, left, [&](int next, double distance2) {
      const double then = left - distance2 - t.chi2(next);
      if (then < 0.0 || (!dim_allowed && t.dim(next))) return;
      t.chosen.push_back(next);
      extend(better, then);
      t.chosen.pop_back();
    });
  }

  search_trial& trial_;
  double total_ = 0.0;  // chi2
};

}  // namespace scifi
