// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <scifi/event/candidate.hpp>
#include <scifi/event/space_point.hpp>

namespace scifi {

/// Working memory of `select_disjoint`.
struct disjoint_buffers {
  std::vector<std::size_t> order;
  std::vector<double> score;
};

/// Appends the best candidates that share at most `max_shared` clusters with better ones, taken now or before, and marks their clusters as used.
/// Best: smallest chi2 - gain x clusters. Two true tracks cross the same channel of a plane now and then; one track found twice shares most of them.
inline void select_disjoint(const std::vector<candidate>& found, std::span<const space_point> points, double gain, int max_shared, std::vector<char>& cluster_used,
                            std::vector<candidate>& selected, disjoint_buffers& work) {
  work.order.clear();
  work.score.clear();
  for (std::size_t i = 0; i < found.size(); ++i) {
    double clusters = 0.0;
    for (const int point : found[i].space_points) clusters += static_cast<double>(points[static_cast<std::size_t>(point)].clusters.size());
    work.score.push_back(found[i].chi2 - gain * clusters);
    work.order.push_back(i);
  }
  std::sort(work.order.begin(), work.order.end(), [&](std::size_t a, std::size_t b) { return work.score[a] != work.score[b] ? work.score[a] < work.score[b] : a < b; });
  const auto each_cluster = [&](const candidate& c, const auto& action) {
    for (const int point : c.space_points)
      for (const int cluster : points[static_cast<std::size_t>(point)].clusters) action(cluster_used[static_cast<std::size_t>(cluster)]);
  };
  for (const std::size_t i : work.order) {
    int shared = 0;
    each_cluster(found[i], [&](char used) { shared += used; });
    if (shared > max_shared) continue;
    each_cluster(found[i], [](char& used) { used = 1; });
    selected.push_back(found[i]);
  }
}

}  // namespace scifi
