// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <scifi/field/grid_axis.hpp>
#include <scifi/io/field_map_text.hpp>
#include <scifi/io/input_error.hpp>

namespace scifi::detail {

/// The points of a field map put on their grid, mirrored parts added. D coordinates, D components; the last coordinate runs fastest.
template <std::size_t D>
class field_map_grid {
 public:
  std::array<grid_axis, D> axes;
  std::vector<std::array<double, D>> values;

  /// Throws input_error where points do not make a full, evenly spaced grid.
  explicit field_map_grid(const field_map_text& text) : text_(text) {
    for (std::size_t d = 0; d < D; ++d) find_axis(d);
    place_points();
    for (const field_map_mirror& m : text.mirrors) unfold(m);
  }

 private:
  [[noreturn]] void fail(long line, std::size_t column, const std::string& reason) const {
    throw input_error(text_.file(), line, column < text_.names.size() ? std::string(text_.names[column]) : "", reason);
  }
  [[nodiscard]] static std::string in_mm(double x) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), x, std::chars_format::general, 8).ptr;
    return std::string(digits.data(), end) + " mm";
  }

  void find_axis(std::size_t d) {
    std::vector<double> places;
    for (const field_map_row& row : text_.rows) places.push_back(row.value[d]);
    std::sort(places.begin(), places.end());
    const double same = 1e-6 * (places.back() - places.front());  // decimals of one place may differ in their last digit
    places.erase(std::unique(places.begin(), places.end(), [same](double a, double b) { return b - a <= same; }), places.end());
    if (places.size() < 3) fail(0, d, "has " + std::to_string(places.size()) + (places.size() == 1 ? " place" : " places") + ", a grid needs three or more");
    const double step = (places.back() - places.front()) / static_cast<double>(places.size() - 1);
    axes[d] = {places.front(), step, places.size()};
    constexpr double tolerance = 1e-3;  // of a step: rounded decimals
    for (std::size_t i = 0; i < places.size(); ++i)
      if (std::abs(places[i] - axes[d].at(i)) > tolerance * step)
        fail(0, d, "the places are not at equal distances: " + in_mm(places[i]) + " stands where " + in_mm(axes[d].at(i)) + " belongs");
  }

  void place_points() {
    std::size_t points = 1;
    for (const grid_axis& a : axes) points *= a.count;
    if (points > 100 * text_.rows.size()) fail(0, text_.names.size(), "the points do not fill a grid");
    values.resize(points);
    std::vector<long> line(points, 0);
    for (const field_map_row& row : text_.rows) {
      std::size_t at = 0;
      for (std::size_t d = 0; d < D; ++d) at = at * axes[d].count + static_cast<std::size_t>(std::lround((row.value[d] - axes[d].first) / axes[d].step));
      if (line[at] != 0) fail(row.line, text_.names.size(), "the point of line " + std::to_string(line[at]) + " once more");
      line[at] = row.line;
      for (std::size_t c = 0; c < D; ++c) values[at][c] = row.value[D + c];
    }
    for (std::size_t i = 0; i < points; ++i) {
      if (line[i] != 0) continue;
      std::string where;
      for (std::size_t d = D, rest = i; d-- > 0; rest /= axes[d].count) {
        const std::string one = std::string(text_.names[d]) + " = " + in_mm(axes[d].at(rest % axes[d].count));
        where = where.empty() ? one : one + ", " + where;
      }
      fail(0, text_.names.size(), "the grid has no point at " + where);
    }
  }

  /// Adds the other half; the plane itself is there once.
  void unfold(const field_map_mirror& m) {
    grid_axis& axis = axes[m.axis];
    const double close = 1e-3 * axis.step;
    const bool upper = std::abs(axis.first) < close;  // the file gives the half above 0
    if (!upper && std::abs(axis.last()) >= close) fail(m.line, m.axis, "is mirrored but its grid neither begins nor ends with 0");
    const std::size_t n = axis.count, full = 2 * n - 1;
    std::size_t inner = 1;
    for (std::size_t d = m.axis + 1; d < D; ++d) inner *= axes[d].count;
    const std::size_t outer = values.size() / (inner * n);

    double largest = 0.0;
    for (const auto& v : values)
      for (const double b : v) largest = std::max(largest, std::abs(b));
    constexpr double rounding = 1e-6;  // of the largest field
    std::vector<std::array<double, D>> both(outer * full * inner);
    for (std::size_t o = 0; o < outer; ++o)
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < inner; ++k) {
          std::array<double, D> own = values[(o * n + i) * inner + k], other = own;
          const bool on_plane = i == (upper ? 0 : n - 1);
          for (std::size_t c = 0; c < D; ++c) {
            other[c] *= m.sign[c];
            if (!on_plane || m.sign[c] > 0) continue;
            if (std::abs(own[c]) > rounding * largest) fail(m.line, D + c, "is odd but not zero on the plane of the mirror");
            own[c] = other[c] = 0.0;
          }
          // Of the full axis: where this point stands, and where its image does.
          const std::size_t here = upper ? n - 1 + i : i;
          both[(o * full + here) * inner + k] = own;
          both[(o * full + (full - 1 - here)) * inner + k] = other;
        }
    values.swap(both);
    const double end = upper ? axis.last() : -axis.first;
    axis = {-end, end / static_cast<double>(n - 1), full};
  }

  const field_map_text& text_;
};

}  // namespace scifi::detail
