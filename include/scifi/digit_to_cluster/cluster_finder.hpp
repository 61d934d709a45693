// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <ranges>
#include <span>
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
/// A digit of a channel that the detector does not have or that has a digit already, or with light that is no number below `most_npe`, is left out.
template <cluster_resolution Resolution = fibre_resolution>
struct cluster_finder {
  double min_npe = 2.0;
  Resolution resolution{};
  static constexpr double most_npe = 1.0e9;  ///< photo-electrons: no photon counter gives more, and sums of them stay finite

  /// Sorts `digits` (any digit_record) by channel and appends the clusters, ordered by tracker, station, plane and channel. `first_digit` refers to the
  /// sorted order. Returns false when digits had to be left out; those with too little light do not count.
  template <std::ranges::contiguous_range Digits>
    requires digit_record<std::ranges::range_value_t<Digits>>
  bool operator()(const detector& where, Digits& digits, std::vector<cluster>& clusters) const {
    std::ranges::sort(digits, std::less{}, [](const auto& d) { return channel_of(d); });
    const std::span<const std::ranges::range_value_t<Digits>> all(digits);
    bool complete = true;
    for (std::size_t i = 0; i < all.size();) {
      if (light_of(all[i]) < min_npe) {
        ++i;
        continue;
      }
      const plane* const p = where.find_plane(channel_of(all[i]));
      const bool repeated = i > 0 && channel_of(all[i - 1]) == channel_of(all[i]);
      if (p == nullptr || repeated || !can_be_in(*p, all[i])) {
        complete = false;
        ++i;
        continue;
      }
      std::size_t end = i + 1;
      while (end < all.size() && light_of(all[end]) >= min_npe && next_to(channel_of(all[end - 1]), channel_of(all[end])) && can_be_in(*p, all[end])) ++end;
      cut(*p, all, i, end, clusters);
      i = end;
    }
    return complete;
  }

 private:
  /// False too for light that is no number.
  template <class Digit>
  [[nodiscard]] static bool can_be_in(const plane& p, const Digit& d) {
    return p.has_channel(channel_of(d).channel) && light_of(d) <= most_npe;
  }
  [[nodiscard]] static bool next_to(channel_id lower, const channel_id& upper) {
    ++lower.channel;
    return lower == upper;
  }

  /// Clusters of the run [begin, end), in order of channel.
  template <class Digit>
  void cut(const plane& p, std::span<const Digit> digits, std::size_t begin, std::size_t end, std::vector<cluster>& clusters) const {
    const auto first = static_cast<std::ptrdiff_t>(clusters.size());
    take_brightest(p, digits, begin, end, clusters);
    if (end - begin > 2) std::sort(clusters.begin() + first, clusters.end(), [](const cluster& a, const cluster& b) { return a.first_digit < b.first_digit; });
  }

  /// The brightest channel takes its brighter neighbour, what is left on either side is cut again: the shorter side first, by a call of this function,
  /// which goes no deeper than the logarithm of the length.
  template <class Digit>
  void take_brightest(const plane& p, std::span<const Digit> digits, std::size_t begin, std::size_t end, std::vector<cluster>& clusters) const {
    const auto brighter = [&digits](std::size_t a, std::size_t b) { return light_of(digits[a]) < light_of(digits[b]); };
    while (end - begin > 2) {
      std::size_t seed = begin;
      for (std::size_t i = begin; i < end; ++i)
        if (brighter(seed, i)) seed = i;
      const bool left = seed > begin && (seed + 1 == end || brighter(seed + 1, seed - 1));
      const std::size_t first = left ? seed - 1 : seed;
      clusters.push_back(make(p, digits, first, first + 2));
      if (first - begin < end - first - 2) {
        take_brightest(p, digits, begin, first, clusters);
        begin = first + 2;
      } else {
        take_brightest(p, digits, first + 2, end, clusters);
        end = first;
      }
    }
    if (begin < end) clusters.push_back(make(p, digits, begin, end));
  }

  template <class Digit>
  [[nodiscard]] cluster make(const plane& p, std::span<const Digit> digits, std::size_t begin, std::size_t end) const {
    cluster c;
    const channel_id id = channel_of(digits[begin]);
    c.tracker = id.tracker;
    c.station = id.station;
    c.plane = id.plane;
    c.first_digit = static_cast<int>(begin);
    c.size = static_cast<int>(end - begin);
    cluster_light light{c.size, light_of(digits[begin]), 0.0};
    double channels = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      const double npe = light_of(digits[i]);
      channels += channel_of(digits[i]).channel;
      light.total += npe;
      light.least = std::min(light.least, npe);
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
