// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <scifi/cluster_to_space_point/crossing.hpp>
#include <scifi/event/cluster.hpp>
#include <scifi/event/space_point.hpp>
#include <scifi/geometry/tracker.hpp>

namespace scifi {

/// Whether a cluster may serve in more than one triplet. `once`: best triplets first, each cluster used once. `shared`: every triplet that is consistent, for
/// pattern recognition to choose among; doublets are made only of clusters in no triplet.
enum class cluster_use { once, shared };

/// Clusters to space points: triplets whose three coordinates agree, then doublets of what is left.
///
/// Kuno's conjecture: for three planes at 120 degrees the channel numbers of one point add to a constant, |sum n - sum n0| < tolerance. Triplets are
/// ranked by the chi2 of their crossing (consistency), ties by light. A doublet is any crossing of two leftover clusters inside the tracker;
/// it has no check of its own, so the brighter come first.
struct space_point_finder {
  double channel_sum_tolerance = 3.0;  ///< K, in channels
  double slope_spread = 0.25;          ///< typical slope of a track, for the distance between the planes
  cluster_use use = cluster_use::once;
  bool doublets = true;
  std::size_t max_points_per_station = 20000;  ///< triplets, and likewise doublets, that are looked at

  /// Working memory, to be handed in again.
  struct buffers {
    std::vector<space_point> found;
    std::vector<int> order;
    std::vector<char> used;
  };

  /// Appends the space points of one tracker, ordered by station. `clusters` as the cluster finder leaves them. Returns false when the
  /// bound on points was reached in a station.
  bool operator()(const tracker& where, std::span<const cluster> clusters, std::vector<space_point>& points, buffers& work) const {
    bool complete = true;
    work.used.assign(clusters.size(), 0);
    for (const station& s : where.stations) {
      const auto less = [](const cluster& c, const std::array<int, 3>& key) { return std::array<int, 3>{c.tracker, c.station, c.plane} < key; };
      const auto range = [&](int plane) {
        const auto first = std::lower_bound(clusters.begin(), clusters.end(), std::array<int, 3>{where.id, s.id, plane}, less);
        const auto last = std::lower_bound(first, clusters.end(), std::array<int, 3>{where.id, s.id, plane + 1}, less);
        return std::pair{static_cast<int>(first - clusters.begin()), static_cast<int>(last - clusters.begin())};
      };
      complete = triplets(where, s, clusters, range, points, work) && complete;
      if (doublets) complete = make_doublets(where, s, clusters, range, points, work) && complete;
    }
    return complete;
  }

 private:
  template <class Range>
  bool triplets(const tracker& where, const station& s, std::span<const cluster> clusters, const Range& range, std::vector<space_point>& points, buffers& work) const {
    if (s.planes.size() != 3) return true;
    const auto [v0, v1] = range(0);
    const auto [w0, w1] = range(1);
    const auto [u0, u1] = range(2);
    const double sum = s.channel_sum();
    bool complete = true;
    work.found.clear();
    for (int v = v0; v < v1; ++v) {
      for (int w = w0; w < w1; ++w) {
        const double rest = sum - clusters[index(v)].channel - clusters[index(w)].channel;
        // Clusters of a plane are in order of channel: only those within the tolerance are looked at.
        auto u = std::upper_bound(clusters.begin() + u0, clusters.begin() + u1, rest - channel_sum_tolerance,
                                  [](double key, const cluster& c) { return key < c.channel; });
        for (; u != clusters.begin() + u1 && u->channel < rest + channel_sum_tolerance; ++u) {
          if (work.found.size() == max_points_per_station) {
            complete = false;
            break;
          }
          add(where, s, clusters, std::array{v, w, static_cast<int>(u - clusters.begin())}, work.found);
        }
      }
    }
    sort_into(work, [](const space_point& a, const space_point& b) { return a.chi2 != b.chi2 ? a.chi2 < b.chi2 : a.npe > b.npe; });
    for (const int i : work.order) {
      const space_point& p = work.found[index(i)];
      if (use == cluster_use::once && any_used(p, work)) continue;
      points.push_back(p);
      if (use == cluster_use::once) mark(p, work);
    }
    if (use == cluster_use::shared)
      for (const space_point& p : work.found) mark(p, work);
    return complete;
  }

  template <class Range>
  bool make_doublets(const tracker& where, const station& s, std::span<const cluster> clusters, const Range& range, std::vector<space_point>& points, buffers& work) const {
    bool complete = true;
    work.found.clear();
    const int planes = static_cast<int>(s.planes.size());
    for (int a = 0; a < planes; ++a) {
      for (int b = a + 1; b < planes; ++b) {
        const auto [a0, a1] = range(a);
        const auto [b0, b1] = range(b);
        for (int i = a0; i < a1; ++i)
          for (int j = b0; j < b1; ++j)
            if (!work.used[index(i)] && !work.used[index(j)]) {
              if (work.found.size() < max_points_per_station) add(where, s, clusters, std::array{i, j}, work.found);
              else complete = false;
            }
      }
    }
    sort_into(work, [](const space_point& a, const space_point& b) { return a.npe > b.npe; });
    for (const int i : work.order) {
      const space_point& p = work.found[index(i)];
      if (use == cluster_use::once && any_used(p, work)) continue;
      points.push_back(p);
      if (use == cluster_use::once) mark(p, work);
    }
    return complete;
  }

  template <std::size_t N>
  void add(const tracker& where, const station& s, std::span<const cluster> clusters, const std::array<int, N>& chosen, std::vector<space_point>& out) const {
    std::array<const cluster*, N> members{};
    for (std::size_t i = 0; i < N; ++i) members[i] = &clusters[index(chosen[i])];
    const crossing_point c = cross(s, members, slope_spread);
    if (!c.defined) return;
    const double radius = where.active_radius + s.planes.front().channel_width;
    const vector<double, 2> from_axis = c.position - s.in_tracker.origin.head<2>();
    if (!(from_axis.norm() <= radius)) return;
    space_point p;
    p.tracker = where.id;
    p.station = s.id;
    p.position = c.position;
    p.covariance = c.covariance;
    p.z = c.z;
    p.chi2 = c.chi2;
    for (std::size_t i = 0; i < N; ++i) {
      p.clusters.push_back(chosen[i]);
      p.npe += members[i]->npe;
    }
    out.push_back(p);
  }

  template <class Less>
  static void sort_into(buffers& work, const Less& less) {
    work.order.resize(work.found.size());
    for (std::size_t i = 0; i < work.order.size(); ++i) work.order[i] = static_cast<int>(i);
    std::sort(work.order.begin(), work.order.end(), [&](int a, int b) { return less(work.found[index(a)], work.found[index(b)]); });
  }

  [[nodiscard]] static bool any_used(const space_point& p, const buffers& work) {
    return std::any_of(p.clusters.begin(), p.clusters.end(), [&](int c) { return work.used[index(c)] != 0; });
  }
  static void mark(const space_point& p, buffers& work) {
    for (const int c : p.clusters) work.used[index(c)] = 1;
  }
  [[nodiscard]] static std::size_t index(int i) { return static_cast<std::size_t>(i); }
};

}  // namespace scifi
