// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <scifi/core/linalg.hpp>
#include <scifi/core/refuse.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/field/concepts.hpp>
#include <scifi/field/interpolation.hpp>
#include <scifi/field/sampled_grid.hpp>

namespace scifi {

/// A field that is the same all round the z axis, from a table of Br and Bz over r and z. Br is odd in r and Bz even, and the interpolation knows it.
template <class Interpolation = cubic_interpolation>
class cylindrical_map {
 public:
  using point = std::array<double, 2>;  ///< Br, Bz in (MeV/c)/(e mm)

  /// Values with z running fastest. Throws std::invalid_argument unless r begins with 0, for a Br on the axis, and where sampled_grid does.
  cylindrical_map(const grid_axis& r, const grid_axis& z, const std::vector<point>& values, outside_map outside)
      : grid_({r, z}, values, {-1, 1}), outside_(outside) {
    if (r.first != 0.0) detail::refuse<std::invalid_argument>("scifi: the radii of a cylindrical field map must begin with 0");
    for (std::size_t i = 0; i < z.count; ++i)
      if (values[i][0] != 0.0) detail::refuse<std::invalid_argument>("scifi: the radial field of a cylindrical field map is not zero on the axis");
  }

  template <single_number Scalar>
  [[nodiscard]] vector<Scalar, 3> operator()(const vector<Scalar, 3>& position) const {
    return with_gradient(position).value;
  }

  template <single_number Scalar>
  [[nodiscard]] field_and_gradient<Scalar> with_gradient(const vector<Scalar, 3>& position) const {
    using std::sqrt;
    const Scalar x = position[0], y = position[1];
    const Scalar r_2 = x * x + y * y;
    const auto on_axis = r_2 <= Scalar(1e-12 * grid_.axes()[0].step * grid_.axes()[0].step);  // not NaN
    const Scalar safe = sqrt(select(on_axis, Scalar(1.0), r_2));
    const Scalar r = select(on_axis, Scalar(0.0), safe);
    const grid_place<Scalar> at_r = place_on(grid_.axes()[0], r), at_z = place_on(grid_.axes()[1], Scalar(position[2]));
    field_and_gradient<Scalar> out;
    if (!(at_r.inside && at_z.inside) && outside_ != outside_map::nearest) {
      const Scalar nothing(outside_ == outside_map::zero ? 0.0 : std::numeric_limits<double>::quiet_NaN());
      out.value.setConstant(nothing);
      out.gradient.setConstant(nothing);
      return out;
    }
    const auto s = grid_.template sample<Scalar>({at_r, at_z});
    const auto& [by_r, by_z] = s.slope[0];
    const Scalar zero(0.0);
    const Scalar c = select(on_axis, zero, Scalar(x / safe)), d = select(on_axis, zero, Scalar(y / safe));
    const Scalar per_r = select(on_axis, by_r, Scalar(s.value[0] / safe));
    const Scalar rest = by_r - per_r;  // Br'- Br/r
    out.value << per_r * x, per_r * y, s.value[1];
    out.gradient << per_r + c * c * rest, c * d * rest, c * by_z,  //
        c * d * rest, per_r + d * d * rest, d * by_z,              //
        c * s.slope[1][0], d * s.slope[1][0], s.slope[1][1];
    return out;
  }

  [[nodiscard]] const grid_axis& r() const { return grid_.axes()[0]; }
  [[nodiscard]] const grid_axis& z() const { return grid_.axes()[1]; }
  [[nodiscard]] const point& at(std::size_t i_r, std::size_t i_z) const { return grid_.at({i_r, i_z}); }

 private:
  sampled_grid<2, 2, Interpolation> grid_;
  outside_map outside_;
};

}  // namespace scifi
