// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include <scifi/study/binomial_interval.hpp>
#include <scifi/study/contents.hpp>
#include <scifi/study/momentum_bins.hpp>
#include <scifi/study/true_track.hpp>

namespace scifi::study {

/// Found of expected.
struct found_share {
  long expected = 0;
  long found = 0;

  void operator()(bool was_found) {
    ++expected;
    found += was_found ? 1 : 0;
  }
  found_share& operator+=(const found_share& other) {
    each(merge, other);
    return *this;
  }
  /// Calls visit(part), or visit(part, the same one of `other`), for everything that is merged.
  template <class Visit, class... Others>
  void each(const Visit& visit, const Others&... other) {
    visit(expected, other.expected...);
    visit(found, other.found...);
  }
  /// NaN where nothing was expected.
  [[nodiscard]] double value() const { return static_cast<double>(found) / static_cast<double>(expected); }
  [[nodiscard]] probability_interval interval(double sigmas = 1.0) const {
    return wilson_interval(static_cast<double>(found), static_cast<double>(expected), sigmas);
  }
};

/// Share of expected particles that have a track, in all and against their true pt and |pz| at the reference surface. Merged with +=.
class efficiency {
 public:
  explicit efficiency(const momentum_edges& edges = {}) : grid_(make_momentum_grid<found_share>(edges)) {}

  /// An expected particle, and whether a track of it was found.
  void add(const true_track& particle, bool found) {
    all_(found);
    grid_(particle.pt(), std::abs(particle.reference()->momentum.z()), boost::histogram::sample(found));
  }
  efficiency& operator+=(const efficiency& other) {
    each(merge, other);
    return *this;
  }
  /// Calls visit(part), or visit(part, the same one of `other`), for everything that is merged.
  template <class Visit, class... Others>
  void each(const Visit& visit, const Others&... other) {
    visit(all_, other.all_...);
    visit(grid_, other.grid_...);
  }

  [[nodiscard]] const found_share& all() const { return all_; }
  [[nodiscard]] const momentum_grid<found_share>& grid() const { return grid_; }

 private:
  found_share all_;
  momentum_grid<found_share> grid_;
};

}  // namespace scifi::study
