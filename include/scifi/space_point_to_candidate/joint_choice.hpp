// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <scifi/event/candidate.hpp>
#include <scifi/event/space_point.hpp>

namespace scifi {

/// Working memory of `select_jointly`.
struct joint_buffers {
  std::vector<std::size_t> order;
  std::vector<double> score;
  std::vector<std::size_t> begin;  // of each one's clusters in the next
  std::vector<std::size_t> clusters;
  std::vector<double> chosen;  // how much of each candidate is, 0 to 1
  std::vector<double> load;    // sum of that on each cluster
};

/// How much candidates that compete for clusters are chosen.
struct joint_choice {
  double gain = 10.0;             ///< chi2 that a cluster explained is worth
  int max_shared = 6;             ///< clusters that one chosen may share with those chosen before it
  std::size_t most = 2000;        ///< candidates that are weighed, the best
};

/// Appends candidates chosen as a set and marks their clusters as used: a false one may be better than each true one that it robs of a cluster or two, but leaves
/// the rest of theirs without an explanation. Sought is the largest
///   gain x (clusters explained) - sum of chi2,
/// by mean-field annealing (Peterson, NIM A 279 (1989) 537): each candidate is chosen in part,
///   x = 1 / (1 + exp(E / T)),  E = chi2 - gain x sum over its clusters of (1 - what the others have of it),
/// while T falls. Those chosen by more than half are taken in order of x.
inline void select_jointly(const std::vector<candidate>& found, std::span<const space_point> points, const joint_choice& settings, std::vector<char>& cluster_used,
                           std::vector<candidate>& selected, joint_buffers& work) {
  work.order.clear();
  work.score.clear();
  work.begin.assign(1, 0);
  work.clusters.clear();
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const int p : found[i].space_points)
      for (const int c : points[static_cast<std::size_t>(p)].clusters) work.clusters.push_back(static_cast<std::size_t>(c));
    work.begin.push_back(work.clusters.size());
    work.score.push_back(found[i].chi2 - settings.gain * static_cast<double>(work.begin[i + 1] - work.begin[i]));
    work.order.push_back(i);
  }
  const auto better = [&work](std::size_t a, std::size_t b) { return work.score[a] != work.score[b] ? work.score[a] < work.score[b] : a < b; };
  std::sort(work.order.begin(), work.order.end(), better);
  work.order.resize(std::min(work.order.size(), settings.most));
  const auto clusters = [&work](std::size_t i) { return std::span(work.clusters).subspan(work.begin[i], work.begin[i + 1] - work.begin[i]); };

  work.chosen.assign(found.size(), 0.0);
  work.load.assign(cluster_used.size(), 0.0);
  // From where a few clusters more or less do not matter yet, to below what one cluster is worth.
  constexpr int steps = 40;
  constexpr double hottest = 6.0, coldest = 0.3;  // in units of the gain
  const double cooling = std::pow(coldest / hottest, 1.0 / (steps - 1));
  double temperature = hottest * settings.gain;
  for (int step = 0; step < steps; ++step, temperature *= cooling) {
    for (const std::size_t i : work.order) {
      double load = 0.0;
      for (const std::size_t c : clusters(i)) load += work.load[c] - work.chosen[i];
      const double now = 1.0 / (1.0 + std::exp((work.score[i] + settings.gain * load) / temperature));
      const double change = now - work.chosen[i];
      work.chosen[i] = now;
      for (const std::size_t c : clusters(i)) work.load[c] += change;
    }
  }

  std::sort(work.order.begin(), work.order.end(), [&](std::size_t a, std::size_t b) { return work.chosen[a] != work.chosen[b] ? work.chosen[a] > work.chosen[b] : better(a, b); });
  for (const std::size_t i : work.order) {
    if (!(work.chosen[i] > 0.5)) break;
    int shared = 0;
    for (const std::size_t c : clusters(i)) shared += cluster_used[c];
    if (shared > settings.max_shared) continue;
    for (const std::size_t c : clusters(i)) cluster_used[c] = 1;
    selected.push_back(found[i]);
  }
}

}  // namespace scifi
