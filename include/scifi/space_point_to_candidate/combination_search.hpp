// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <scifi/core/constants.hpp>
#include <scifi/event/candidate.hpp>
#include <scifi/event/space_point.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/space_point_to_candidate/arc_fit.hpp>
#include <scifi/space_point_to_candidate/station_scattering.hpp>
#include <scifi/space_point_to_candidate/track_finder_options.hpp>
#include <scifi/track_model/slope_state.hpp>

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
      : where_(setting), options_(setting.options), scattering_(setting.scattering), points_(space_points), work_(memory), budget_(setting.options.max_arc_fits) {}

  /// Fills `work.found` with the candidates through `size` stations, from points whose clusters are free.
  void operator()(int size) {
    collect_free();
    work_.found.clear();
    choose_stations(0, size);
  }

  /// False once the bound on the number of arc fits was reached.
  [[nodiscard]] bool complete() const { return budget_ > 0; }

 private:
  void collect_free() {
    for (auto& list : work_.points) list.clear();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const space_point& p = points_[i];
      if (p.tracker != where_.id) continue;
      if (std::any_of(p.clusters.begin(), p.clusters.end(), [&](int c) { return work_.cluster_used[static_cast<std::size_t>(c)] != 0; })) continue;
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

  [[nodiscard]] double momentum(double w, double t2) const {
    const track_finder_options& o = options_;
    if (!bent()) return o.line_momentum;
    // Bounded so that an unbent track is not taken for one that does not scatter.
    const double k = std::abs(w / o.field);
    return std::sqrt(1.0 + t2) / std::clamp(k, 0.5 * (o.typical_q_over_pz - 0.75 * o.spread_q_over_pz), 1.0 / o.smallest_pz);
  }

  [[nodiscard]] arc_prior prior(double w) const {
    const track_finder_options& o = options_;
    arc_prior p;
    p.slope_variance = 0.25 * o.largest_slope * o.largest_slope;
    if (bent()) {
      p.curvature = std::copysign(o.typical_q_over_pz * o.field, w);
      p.curvature_variance = o.spread_q_over_pz * o.spread_q_over_pz * o.field * o.field;
    }
    return p;
  }

  /// One pass over the chosen points with the curvature given.
  [[nodiscard]] arc_fit pass(double w, double t2) {
    --budget_;
    const double p = momentum(w, t2);
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
      const double limit = 0.5 * std::abs(options_.typical_q_over_pz * options_.field);
      fit = pass(fit.curvature() + std::clamp(step, -limit, limit), norm(fit.slope()));
      if (step * step < 0.01 * fit.curvature_variance()) break;
    }
    return fit;
  }

  [[nodiscard]] bool too_steep(const arc_point& a, const arc_point& b) const {
    const double reach = options_.largest_slope * (b.z - a.z) + 5.0 * std::sqrt(a.variance + b.variance);
    return norm(b.position - a.position) > reach * reach;
  }

  void start() {
    for (const int a : list(0)) {
      for (const int b : list(1)) {
        if (too_steep(arc(a), arc(b))) continue;
        for (const int c : list(2)) {
          if (budget_ <= 0) return;
          if (!too_steep(arc(b), arc(c))) triple(a, b, c);
        }
      }
    }
  }

  void triple(int a, int b, int c) {
    chosen_.clear();
    for (const int point : {a, b, c}) chosen_.push_back(point);
    if (!bent()) {
      follow(pass(0.0, 0.0));
      return;
    }
    const track_finder_options& o = options_;
    const arc_point& pa = arc(a);
    const arc_point& pb = arc(b);
    const arc_point& pc = arc(c);
    const planar<double> first = pb.position - pa.position;
    const planar<double> second = pc.position - pb.position;
    const double half = 0.5 * (pc.z - pa.z);
    const double largest = std::abs(o.field) / o.smallest_pz;
    const planar<double> product = conjugate(first) * second;
    const double angle = -std::atan2(product.y, product.x);  // w half, modulo 2 pi
    const double full_turn = 2.0 * constants::pi;
    const int turns = static_cast<int>(std::ceil(largest * half / full_turn));
    const double length1 = std::sqrt(norm(first));
    const double length2 = std::sqrt(norm(second));
    for (int n = -turns; n <= turns; ++n) {
      const double w = (angle + n * full_turn) / half;
      if (std::abs(w) > largest) continue;
      const double ratio = chord(w, pc.z - pb.z) / chord(w, pb.z - pa.z);
      const double scatter = scattering_.slope_variance(static_cast<std::size_t>(stations_[1]), momentum(w, 0.0), 0.0);
      const double variance = pa.variance * ratio * ratio + pb.variance * (1.0 + ratio) * (1.0 + ratio) + pc.variance + scatter * (pc.z - pb.z) * (pc.z - pb.z);
      const double miss = length2 - ratio * length1;
      if (miss * miss < o.gate * variance) follow(refine(w, 1));
    }
    // Where the chords are short against their errors the angle between them says nothing: both senses of rotation are tried.
    const double blur = pa.variance + pb.variance + scattering_.slope_variance(static_cast<std::size_t>(stations_[0]), momentum(0.0, 0.0), 0.0) * 4.0 * half * half;
    if (norm(first) < 16.0 * blur || norm(second) < 16.0 * blur)
      for (const double sign : {1.0, -1.0}) follow(refine(sign * o.typical_q_over_pz * o.field, 3));
  }

  /// Length of the chord over dz per unit of slope, signed.
  [[nodiscard]] static double chord(double w, double dz) {
    const double x = 0.5 * w * dz;
    return std::abs(x) < 1e-6 ? dz : dz * std::sin(x) / x;
  }

  /// Extends the chosen points through the remaining stations.
  void follow(const arc_fit& fit) {
    const track_finder_options& o = options_;
    const std::size_t level = chosen_.size();
    const double ndf = 2.0 * static_cast<double>(level) - (bent() ? 5.0 : 4.0);
    if (fit.chi2_after_step() > o.chi2_per_ndf * ndf + o.gate) return;
    if (level == stations_.size()) {
      finish(fit);
      return;
    }
    const double t2 = norm(fit.slope());
    const double scatter = scattering_.slope_variance(static_cast<std::size_t>(stations_[level - 1]), momentum(fit.curvature(), t2), t2);
    for (const int next : list(level)) {
      arc_fit ahead = fit;
      ahead.fly(arc(next).z, scatter);
      if (ahead.distance2(arc(next)) > o.gate || budget_ <= 0) continue;
      chosen_.push_back(next);
      follow(refine(fit.curvature(), 2));
      chosen_.pop_back();
    }
  }

  void finish(const arc_fit& fit) {
    const track_finder_options& o = options_;
    const int ndf = 2 * static_cast<int>(chosen_.size()) - (bent() ? 5 : 4);
    if (fit.chi2() > o.chi2_per_ndf * ndf || norm(fit.slope()) > o.largest_slope * o.largest_slope) return;
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
    seed(fit, c);
    // The same points by another hypothesis: keep the better.
    if (!work_.found.empty() && std::equal(c.space_points.begin(), c.space_points.end(), work_.found.back().space_points.begin(), work_.found.back().space_points.end())) {
      if (c.chi2 < work_.found.back().chi2) work_.found.back() = c;
      return;
    }
    work_.found.push_back(c);
  }

  /// The filtered state at the last point, tracker frame, with its covariance.
  void seed(const arc_fit& fit, candidate& c) const {
    using s = slope_state;
    const track_finder_options& o = options_;
    auto& m = c.seed.mean;
    auto& v = c.seed.covariance;
    m[s::x] = fit.position().x;
    m[s::y] = fit.position().y;
    m[s::tx] = fit.slope().x;
    m[s::ty] = fit.slope().y;
    const double path = std::sqrt(1.0 + norm(fit.slope()));
    m[s::q_over_pz] = bent() ? fit.curvature() / o.field : where_.travel * o.line_charge * path / o.line_momentum;
    v.setZero();
    v(s::x, s::x) = v(s::y, s::y) = fit.position_variance();
    v(s::tx, s::tx) = v(s::ty, s::ty) = fit.slope_variance();
    // E dp conj(ds) = a + ib: x goes with tx as y with ty (a), y with tx as x against ty (b).
    const planar<double> ps = fit.position_slope_covariance();
    v(s::x, s::tx) = v(s::y, s::ty) = ps.x;
    v(s::y, s::tx) = ps.y;
    v(s::x, s::ty) = -ps.y;
    if (bent()) {
      vector<double, 5> d;  // d state / d(q/pz)
      d << fit.d_position().x, fit.d_slope().x, fit.d_position().y, fit.d_slope().y, 1.0 / o.field;
      v.triangularView<Eigen::Upper>() += matrix<double, 5, 5>(fit.curvature_variance() * d * d.transpose());
    }
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < i; ++j) {
        if (v(j, i) == 0.0) v(j, i) = v(i, j);
        v(i, j) = v(j, i);
      }
  }

  [[nodiscard]] bool bent() const { return options_.field != 0.0; }

  const search_setting& where_;
  const track_finder_options& options_;
  const station_scattering& scattering_;
  std::span<const space_point> points_;
  search_buffers& work_;
  int budget_;
  inline_vector<int, max_stations> stations_;  // chosen, indices into where.stations
  inline_vector<int, max_stations> chosen_;    // space points
};

}  // namespace scifi
