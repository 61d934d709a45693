// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/linalg.hpp>
#include <scifi/field/concepts.hpp>

namespace scifi {

/// A field along z that grows along z, with what div B = 0 and curl B = 0 then ask for about the z axis:
///   B = (-gradient x/2, -gradient y/2, field + gradient z).
struct graded_field {
  double field = 0.0;     ///< on the plane z = 0, (MeV/c)/(e mm)
  double gradient = 0.0;  ///< dBz/dz, (MeV/c)/(e mm) per mm

  template <class Scalar>
  [[nodiscard]] vector<Scalar, 3> operator()(const vector<Scalar, 3>& position) const {
    const Scalar across = Scalar(-0.5 * gradient);
    return {Scalar(across * position.x()), Scalar(across * position.y()), Scalar(Scalar(field) + Scalar(gradient) * position.z())};
  }
  template <class Scalar>
  [[nodiscard]] field_and_gradient<Scalar> with_gradient(const vector<Scalar, 3>& position) const {
    matrix<Scalar, 3, 3> change = matrix<Scalar, 3, 3>::Constant(Scalar(0.0));
    change(0, 0) = change(1, 1) = Scalar(-0.5 * gradient);
    change(2, 2) = Scalar(gradient);
    return {(*this)(position), change};
  }
};

}  // namespace scifi
