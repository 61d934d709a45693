// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <scifi/core/linalg.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/field/coil.hpp>
#include <scifi/field/current_sheet.hpp>

namespace scifi {

/// The field of a set of coils, each taken as five current sheets at the points of Gauss and Legendre across its thickness (Abramowitz and Stegun 25.4.30).
///
/// Valid outside of the windings; at a distance from them of the thickness or more the sheets are the coil to 1e-8 of its field. Some microseconds a
/// coil: for many tracks put it into a map (tabulate.hpp). For its gradient see automatic_gradient.hpp.
class coil_field {
 public:
  /// Coils in the frame in which the field is asked.
  explicit coil_field(const std::vector<coil>& coils) {
    for (const coil& c : coils) {
      stack s{c.centre, c.axis.normalized(), {}};
      for (std::size_t i = 0; i < points.size(); ++i) {
        const double radius = c.inner_radius + 0.5 * c.thickness * (1.0 + points[i]);
        s.sheets[i] = {radius, 0.5 * c.length, magnetic_constant * c.current_density * 0.5 * c.thickness * weights[i]};
      }
      stacks_.push_back(s);
    }
  }

  /// B in (MeV/c)/(e mm) at a position in mm.
  template <class Scalar>
  [[nodiscard]] vector<Scalar, 3> operator()(const vector<Scalar, 3>& position) const {
    using std::sqrt;
    vector<Scalar, 3> sum(Scalar(0.0), Scalar(0.0), Scalar(0.0));
    for (const stack& s : stacks_) {
      std::array<Scalar, 3> across{Scalar(position[0] - Scalar(s.centre[0])), Scalar(position[1] - Scalar(s.centre[1])), Scalar(position[2] - Scalar(s.centre[2]))};
      const Scalar z = across[0] * Scalar(s.axis[0]) + across[1] * Scalar(s.axis[1]) + across[2] * Scalar(s.axis[2]);
      for (std::size_t i = 0; i < 3; ++i) across[i] -= z * Scalar(s.axis[static_cast<int>(i)]);
      const Scalar r_2 = across[0] * across[0] + across[1] * across[1] + across[2] * across[2];
      // On the axis, where r has no derivative, what depends on r has none either.
      const auto off_axis = Scalar(0.0) < r_2;
      const Scalar r = select(off_axis, Scalar(sqrt(select(off_axis, r_2, Scalar(1.0)))), Scalar(0.0));
      axial_field<Scalar> b{Scalar(0.0), Scalar(0.0)};
      for (const current_sheet& sheet : s.sheets) {
        const axial_field<Scalar> one = sheet.at(r, z);
        b.radial_per_r += one.radial_per_r;
        b.along += one.along;
      }
      for (int i = 0; i < 3; ++i) sum[i] += b.along * Scalar(s.axis[i]) + b.radial_per_r * across[static_cast<std::size_t>(i)];
    }
    return sum;
  }

 private:
  struct stack {
    vector<double, 3> centre, axis;
    std::array<current_sheet, 5> sheets;
  };
  static constexpr std::array<double, 5> points{-0.906179845938664, -0.538469310105683, 0.0, 0.538469310105683, 0.906179845938664};
  static constexpr std::array<double, 5> weights{0.236926885056189, 0.478628670499366, 0.568888888888889, 0.478628670499366, 0.236926885056189};
  std::vector<stack> stacks_;
};

}  // namespace scifi
