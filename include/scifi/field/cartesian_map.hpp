// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <limits>
#include <vector>

#include <scifi/core/linalg.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/field/concepts.hpp>
#include <scifi/field/interpolation.hpp>
#include <scifi/field/sampled_grid.hpp>

namespace scifi {

/// A field from a table of Bx, By and Bz over x, y and z.
template <class Interpolation = cubic_interpolation>
class cartesian_map {
 public:
  using point = std::array<double, 3>;  ///< Bx, By, Bz in (MeV/c)/(e mm)

  /// Values with z running fastest and x slowest. Throws std::invalid_argument where sampled_grid does.
  cartesian_map(const grid_axis& x, const grid_axis& y, const grid_axis& z, const std::vector<point>& values, outside_map outside)
      : grid_({x, y, z}, values), outside_(outside) {}

  template <single_number Scalar>
  [[nodiscard]] vector<Scalar, 3> operator()(const vector<Scalar, 3>& position) const {
    return with_gradient(position).value;
  }

  template <single_number Scalar>
  [[nodiscard]] field_and_gradient<Scalar> with_gradient(const vector<Scalar, 3>& position) const {
    std::array<grid_place<Scalar>, 3> place;
    bool inside = true;
    for (std::size_t d = 0; d < 3; ++d) {
      place[d] = place_on(grid_.axes()[d], Scalar(position[static_cast<int>(d)]));
      inside = inside && place[d].inside;
    }
    field_and_gradient<Scalar> out;
    if (!inside && outside_ != outside_map::nearest) {
      const Scalar nothing(outside_ == outside_map::zero ? 0.0 : std::numeric_limits<double>::quiet_NaN());
      out.value.setConstant(nothing);
      out.gradient.setConstant(nothing);
      return out;
    }
    const auto s = grid_.sample(place);
    for (int c = 0; c < 3; ++c) {
      const auto component = static_cast<std::size_t>(c);
      out.value[c] = s.value[component];
      for (int d = 0; d < 3; ++d) out.gradient(c, d) = s.slope[component][static_cast<std::size_t>(d)];
    }
    return out;
  }

  [[nodiscard]] const std::array<grid_axis, 3>& axes() const { return grid_.axes(); }
  [[nodiscard]] const point& at(const std::array<std::size_t, 3>& i) const { return grid_.at(i); }

 private:
  sampled_grid<3, 3, Interpolation> grid_;
  outside_map outside_;
};

}  // namespace scifi
