// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <scifi/event/cluster.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/study/contents.hpp>
#include <scifi/study/distribution.hpp>

namespace scifi::study {

/// Sums of channel numbers in one station.
struct station_channel_sums {
  int station = 0;
  double expected = 0.0;  ///< sum of the central channels of its planes
  distribution difference{49, -12.25, 12.25, "sum of channels - expected"};  ///< bins about half channels, which are the steps of the sum
};

/// Kuno's conjecture: the channel numbers of the three clusters of a space point add up to a constant, for the coordinates of three views at 120
/// degrees add up to nothing. Every triplet of clusters counts whose sum lies within `reach` channels of the constant, wrong ones too:
/// those are the ground under the peak. Merged with += where the trackers have the same stations.
class channel_sums {
 public:
  static constexpr double reach = 12.0;

  /// Stations without three planes are left out.
  explicit channel_sums(const tracker& where) : tracker_(where.id) {
    for (const station& s : where.stations)
      if (s.planes.size() == 3) stations_.push_back({.station = s.id, .expected = s.channel_sum()});
  }

  /// Clusters of an event, ordered by tracker, station, plane and channel as the cluster finder leaves them.
  void add(std::span<const cluster> clusters) {
    for (station_channel_sums& s : stations_) {
      const auto plane = [&](int number) {
        const auto less = [](const cluster& c, const std::array<int, 3>& key) { return std::array<int, 3>{c.tracker, c.station, c.plane} < key; };
        const auto first = std::lower_bound(clusters.begin(), clusters.end(), std::array{tracker_, s.station, number}, less);
        return std::span<const cluster>(first, std::lower_bound(first, clusters.end(), std::array{tracker_, s.station, number + 1}, less));
      };
      for (const cluster& a : plane(0)) {
        for (const cluster& b : plane(1)) {
          const double rest = s.expected - a.channel - b.channel;
          const std::span<const cluster> last = plane(2);
          auto c = std::lower_bound(last.begin(), last.end(), rest - reach, [](const cluster& one, double channel) { return one.channel < channel; });
          for (; c != last.end() && c->channel <= rest + reach; ++c) s.difference.add(c->channel - rest);
        }
      }
    }
  }
  channel_sums& operator+=(const channel_sums& other) {
    each(merge, other);
    return *this;
  }
  /// Calls visit(part), or visit(part, the same one of `other`), for everything that is merged.
  template <class Visit, class... Others>
  void each(const Visit& visit, const Others&... other) {
    const std::size_t common = std::min({stations_.size(), other.stations_.size()...});
    for (std::size_t i = 0; i < common; ++i) visit(stations_[i].difference, other.stations_[i].difference...);
  }

  [[nodiscard]] std::span<const station_channel_sums> stations() const { return stations_; }

 private:
  int tracker_;
  std::vector<station_channel_sums> stations_;
};

}  // namespace scifi::study
