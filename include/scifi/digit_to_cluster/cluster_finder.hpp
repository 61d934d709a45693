// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <scifi/digit_to_cluster/cluster_resolution.hpp>
#include <scifi/event/cluster.hpp>
#include <scifi/event/digit.hpp>
#include <scifi/geometry/tracker.hpp>

namespace scifi {

/// Digits to clusters: neighbouring channels of a plane become one crossing.
///
/// Digits below `min_npe` photo-electrons are left out. A run of one or two channels is one cluster; a longer one is cut from its
/// brightest channel outwards into pairs and singles, since one crossing lights at most two channels. The channel is the unweighted mean.
template <cluster_resolution Resolution = fibre_resolution>
struct cluster_finder {
  double min_npe = 2.0;
  Resolution resolution{};

  /// Sorts `digits` by id and appends the clusters, ordered by tracker, station, plane and channel. `first_digit` refers to the sorted order.
  /// Digits of planes that `where` does not have are skipped.
  void operator()(const detector& where, std::vector<digit>& digits, std::vector<cluster>& clusters) const {
    std::sort(digits.begin(), digits.end(), [](const digit& a, const digit& b) { return a.id < b.id; });
    for (std::size_t i = 0; i < digits.size();) {
      if (digits[i].npe < min_npe) {
        ++i;
        continue;
      }
      std::size_t end = i + 1;
      while (end < digits.size() && digits[end].npe >= min_npe && next_to(digits[end - 1].id, digits[end].id)) ++end;
      if (const plane* p = where.find_plane(digits[i].id)) cut(*p, digits, i, end, clusters);
      i = end;
    }
  }

 private:
  [[nodiscard]] static bool next_to(channel_id lower, const channel_id& upper) {
    ++lower.channel;
    return lower == upper;
  }

  /// Clusters of the run [begin, end): the brightest channel takes its brighter neighbour, what is left on either side is cut again.
  void cut(const plane& p, const std::vector<digit>& digits, std::size_t begin, std::size_t end, std::vector<cluster>& clusters) const {
    if (begin == end) return;
    if (end - begin <= 2) {
      clusters.push_back(make(p, digits, begin, end));
      return;
    }
    const auto brighter = [&digits](std::size_t a, std::size_t b) { return digits[a].npe < digits[b].npe; };
    std::size_t seed = begin;
    for (std::size_t i = begin; i < end; ++i)
      if (brighter(seed, i)) seed = i;
    const bool left = seed > begin && (seed + 1 == end || brighter(seed + 1, seed - 1));
    const std::size_t first = left ? seed - 1 : seed;
    cut(p, digits, begin, first, clusters);
    clusters.push_back(make(p, digits, first, first + 2));
    cut(p, digits, first + 2, end, clusters);
  }

  [[nodiscard]] cluster make(const plane& p, const std::vector<digit>& digits, std::size_t begin, std::size_t end) const {
    cluster c;
    const channel_id& id = digits[begin].id;
    c.tracker = id.tracker;
    c.station = id.station;
    c.plane = id.plane;
    c.first_digit = static_cast<int>(begin);
    c.size = static_cast<int>(end - begin);
    cluster_light light{c.size, digits[begin].npe, 0.0};
    double channels = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      channels += digits[i].id.channel;
      light.total += digits[i].npe;
      light.least = std::min(light.least, digits[i].npe);
    }
    c.channel = channels / c.size;
    c.npe = light.total;
    c.alpha = p.alpha(c.channel);
    c.variance = resolution.variance(p, light);
    return c;
  }
};

template <class Resolution>
cluster_finder(double, Resolution) -> cluster_finder<Resolution>;
cluster_finder() -> cluster_finder<fibre_resolution>;

}  // namespace scifi
