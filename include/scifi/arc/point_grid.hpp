// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <scifi/arc/arc_fit.hpp>
#include <scifi/core/planar.hpp>

namespace scifi {

/// The points of one station in square cells, about four for each point, so that those near a place are found without looking at the rest.
class point_grid {
 public:
  void clear() { points_.clear(); }
  [[nodiscard]] bool empty() const { return points_.empty(); }

  /// `points`: indices into `where`, finite positions. Memory of an earlier filling is used again.
  void fill(std::span<const int> points, std::span<const arc_point> where) {
    reach_ = 1.0;
    for (const int p : points) reach_ = std::max({reach_, std::abs(at(where, p).x), std::abs(at(where, p).y)});
    side_ = std::clamp(static_cast<int>(2.0 * std::sqrt(static_cast<double>(points.size()))), 1, most_cells);
    per_mm_ = 0.5 * side_ / reach_;
    begin_.assign(static_cast<std::size_t>(side_ * side_) + 1, 0);
    points_.resize(points.size());
    for (const int p : points) ++begin_[cell(at(where, p)) + 1];
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    // Filled from the back, so that each beginning ends where it belongs and points of a cell keep their order.
    for (std::size_t i = points.size(); i-- > 0;) points_[static_cast<std::size_t>(--begin_[cell(at(where, points[i])) + 1])] = {at(where, points[i]), points[i]};
    for (std::size_t i = 1; i + 1 < begin_.size(); ++i) begin_[i] = begin_[i + 1];
    begin_.back() = static_cast<int>(points.size());
  }

  /// `action(point)` for every point within `reach` of `place` in x and in y.
  template <class Action>
  void near(const planar<double>& place, const planar<double>& reach, const Action& action) const {
    const int x0 = index(place.x - reach.x), x1 = index(place.x + reach.x);
    const int y0 = index(place.y - reach.y), y1 = index(place.y + reach.y);
    for (int y = y0; y <= y1; ++y) {
      const auto row = static_cast<std::size_t>(y * side_);
      const int end = begin_[row + static_cast<std::size_t>(x1) + 1];
      for (int i = begin_[row + static_cast<std::size_t>(x0)]; i < end; ++i) {
        const placed& p = points_[static_cast<std::size_t>(i)];
        if (std::abs(p.at.x - place.x) <= reach.x && std::abs(p.at.y - place.y) <= reach.y) action(p.point);
      }
    }
  }

 private:
  struct placed {
    planar<double> at;
    int point;
  };
  static constexpr int most_cells = 48;  // along a side
  [[nodiscard]] static planar<double> at(std::span<const arc_point> where, int p) { return where[static_cast<std::size_t>(p)].position; }
  /// Places outside, and such as are no number, belong to the cells at the edge.
  [[nodiscard]] int index(double x) const {
    const double place = (x + reach_) * per_mm_;
    return place > 0.0 ? (place < side_ ? static_cast<int>(place) : side_ - 1) : 0;
  }
  [[nodiscard]] std::size_t cell(const planar<double>& p) const { return static_cast<std::size_t>(index(p.y) * side_ + index(p.x)); }

  int side_ = 1;
  double reach_ = 1.0;
  double per_mm_ = 0.5;
  std::vector<int> begin_{0, 0};  // of each cell, row by row, and the end
  std::vector<placed> points_;
};

}  // namespace scifi
