// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include <scifi/core/refuse.hpp>
#include <scifi/field/grid_axis.hpp>

namespace scifi {

/// Components of a field at a place and their derivatives by the coordinates.
template <class Scalar, std::size_t Dimensions, std::size_t Components>
struct grid_sample {
  std::array<Scalar, Components> value{};
  std::array<std::array<Scalar, Dimensions>, Components> slope{};  ///< [component][coordinate], per mm
};

/// Numbers on a regular grid and what lies between: `Interpolation` along each coordinate. Copies share the numbers, which never change.
///
/// A row of points is added all around: by the parabola through the last three points (Keys 1981, eq. 19), so that the edge is as good as the middle, or
/// by the symmetry that the owner knows of. The last coordinate runs fastest.
template <std::size_t Dimensions, std::size_t Components, class Interpolation>
class sampled_grid {
 public:
  using point = std::array<double, Components>;
  using indices = std::array<std::size_t, Dimensions>;

  /// `parity[c]`: +1 or -1 where component c is even or odd in the first coordinate about the axis' first point, 0 where it is neither.
  /// Throws std::invalid_argument unless each axis has three points or more and there are as many values as points.
  sampled_grid(const std::array<grid_axis, Dimensions>& axes, const std::vector<point>& values, const std::array<int, Components>& parity = {}) : axes_(axes) {
    std::size_t points = 1, padded_points = 1;
    for (std::size_t d = Dimensions; d-- > 0;) {
      if (axes[d].count < 3 || !(axes[d].step > 0.0)) detail::refuse<std::invalid_argument>("scifi: an axis of a field map needs three points or more at growing places");
      stride_[d] = padded_points;
      points *= axes[d].count;
      padded_points *= axes[d].count + 2;
    }
    if (values.size() != points) detail::refuse<std::invalid_argument>("scifi: a field map has not as many values as points");
    std::vector<point> padded(padded_points);
    indices at{};
    for (const point& value : values) {
      padded[index_of(at)] = value;
      for (std::size_t d = Dimensions; d-- > 0 && ++at[d] == axes[d].count;) at[d] = 0;
    }
    for (std::size_t d = 0; d < Dimensions; ++d) pad(padded, d, parity);
    values_ = std::make_shared<const std::vector<point>>(std::move(padded));
  }

  [[nodiscard]] const std::array<grid_axis, Dimensions>& axes() const { return axes_; }

  /// The number at a point of the grid.
  [[nodiscard]] const point& at(const indices& i) const { return (*values_)[index_of(i)]; }

  /// Value and slopes at a place; a coordinate beyond an edge is taken at the edge, where the slope along it is zero.
  template <class Scalar>
  [[nodiscard]] grid_sample<Scalar, Dimensions, Components> sample(const std::array<grid_place<Scalar>, Dimensions>& place) const {
    std::array<std::array<Scalar, 4>, Dimensions> weights, slopes;
    std::size_t corner = 0;
    for (std::size_t d = 0; d < Dimensions; ++d) {
      weights[d] = Interpolation::weights(place[d].fraction);
      slopes[d] = Interpolation::slopes(place[d].fraction);
      for (Scalar& s : slopes[d]) s *= Scalar(place[d].inside ? 1.0 / axes_[d].step : 0.0);
      corner += place[d].cell * stride_[d];  // the padding makes up for the point before
    }
    return contracted<Scalar, 0>(corner, weights, slopes);
  }

 private:
  [[nodiscard]] std::size_t index_of(const indices& i) const {
    std::size_t out = 0;
    for (std::size_t d = 0; d < Dimensions; ++d) out += (i[d] + 1) * stride_[d];
    return out;
  }

  /// Sum over the coordinates from D on.
  template <class Scalar, std::size_t D>
  [[nodiscard]] grid_sample<Scalar, Dimensions, Components> contracted(std::size_t offset, const std::array<std::array<Scalar, 4>, Dimensions>& weights,
                                                                       const std::array<std::array<Scalar, 4>, Dimensions>& slopes) const {
    grid_sample<Scalar, Dimensions, Components> sum;
    for (std::size_t c = 0; c < Components; ++c) {
      sum.value[c] = Scalar(0.0);
      for (Scalar& s : sum.slope[c]) s = Scalar(0.0);
    }
    for (std::size_t i = 0; i < 4; ++i, offset += stride_[D]) {
      if constexpr (D + 1 == Dimensions) {
        const point& p = (*values_)[offset];
        for (std::size_t c = 0; c < Components; ++c) {
          sum.value[c] += weights[D][i] * Scalar(p[c]);
          sum.slope[c][D] += slopes[D][i] * Scalar(p[c]);
        }
      } else {
        const auto inner = contracted<Scalar, D + 1>(offset, weights, slopes);
        for (std::size_t c = 0; c < Components; ++c) {
          sum.value[c] += weights[D][i] * inner.value[c];
          sum.slope[c][D] += slopes[D][i] * inner.value[c];
          for (std::size_t d = D + 1; d < Dimensions; ++d) sum.slope[c][d] += weights[D][i] * inner.slope[c][d];
        }
      }
    }
    return sum;
  }

  /// Fills the two planes beyond the ends of coordinate d, for all points that the coordinates before have filled.
  void pad(std::vector<point>& padded, std::size_t d, const std::array<int, Components>& parity) const {
    const std::size_t last = axes_[d].count + 1;
    for (std::size_t i = 0; i < padded.size(); ++i) {
      if (i / stride_[d] % (last + 1) != 0) continue;
      const auto at = [&](std::size_t k) -> point& { return padded[i + k * stride_[d]]; };
      for (std::size_t c = 0; c < Components; ++c) {
        const auto parabola = [c](const point& a, const point& b, const point& e) { return 3.0 * a[c] - 3.0 * b[c] + e[c]; };
        at(0)[c] = d == 0 && parity[c] != 0 ? parity[c] * at(2)[c] : parabola(at(1), at(2), at(3));
        at(last)[c] = parabola(at(last - 1), at(last - 2), at(last - 3));
      }
    }
  }

  std::array<grid_axis, Dimensions> axes_;
  std::array<std::size_t, Dimensions> stride_{};
  std::shared_ptr<const std::vector<point>> values_;
};

}  // namespace scifi
