// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <initializer_list>

#include <scifi/core/constants.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/field/elliptic.hpp>

namespace scifi {

/// A field about an axis, at a distance r from it: Br = radial_per_r r, Bz = along.
template <class Scalar>
struct axial_field {
  Scalar radial_per_r;
  Scalar along;
};

/// A cylinder of no thickness on which a current runs round, the same at every z: an ideal solenoid, centred on z = 0.
struct current_sheet {
  double radius = 0.0;       ///< mm, > 0
  double half_length = 0.0;  ///< mm
  double strength = 0.0;     ///< mu0 times current per length, the field in the middle of a long one, (MeV/c)/(e mm)

  /// Its field at the distance r >= 0 from the axis and at z, mm (Derby and Olbert, Am. J. Phys. 78 (2010) 229, eqs. 2-5), with the radial part
  /// rearranged so that it is exact on the axis; beyond 10^3 times the size of the sheet, where the terms of those cancel, as that of a dipole, within 3e-6 of itself.
  /// Infinite or NaN on the sheet itself.
  template <scalar Scalar>
  [[nodiscard]] axial_field<Scalar> at(const Scalar& r, const Scalar& z) const {
    using std::sqrt;
    const Scalar a = Scalar(radius);
    const Scalar sum = a + r;
    const Scalar gamma = (a - r) / sum;
    const Scalar gamma_2 = gamma * gamma;
    axial_field<Scalar> out{Scalar(0.0), Scalar(0.0)};
    for (const double sign : {1.0, -1.0}) {
      const Scalar to_end = z + Scalar(sign * half_length);
      const Scalar square_sum = to_end * to_end + sum * sum;
      const Scalar root = sqrt(square_sum);
      const Scalar m = Scalar(4.0) * a * r / square_sum;
      const Scalar kc = sqrt(Scalar(to_end * to_end + (a - r) * (a - r))) / root;
      out.radial_per_r -= Scalar(sign) * elliptic_difference(kc, m) / (root * square_sum);
      out.along += Scalar(sign) * to_end / root * complete_elliptic(kc, gamma_2, Scalar(1.0), gamma);
    }
    const Scalar scale = Scalar(strength / constants::pi);
    out.radial_per_r *= scale * Scalar(4.0) * a * a;
    out.along *= scale * a / sum;

    // mu0 / 4 pi times the dipole moment, over the cube of the distance: quotients first, so that no power leaves the range of numbers.
    const Scalar size(radius + half_length);
    const Scalar distance = sqrt(r * r + z * z);
    const auto far = Scalar(1e3) * size < distance;
    const Scalar inverse = Scalar(1.0) / select(far, distance, Scalar(1.0));
    const Scalar cosine = z * inverse;
    const Scalar moment = Scalar(0.5 * strength * half_length * radius * radius) * inverse * inverse * inverse;
    out.along = select(far, Scalar(moment * (Scalar(3.0) * cosine * cosine - Scalar(1.0))), out.along);
    out.radial_per_r = select(far, Scalar(Scalar(3.0) * moment * cosine * inverse), out.radial_per_r);
    return out;
  }
};

}  // namespace scifi
