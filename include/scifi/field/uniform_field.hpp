// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/linalg.hpp>
#include <scifi/field/concepts.hpp>

namespace scifi {

/// The same field everywhere, in any direction.
struct uniform_field {
  vector<double, 3> value = vector<double, 3>::Zero();  ///< (MeV/c)/(e mm): B in tesla times units::tesla

  template <class Scalar>
  [[nodiscard]] vector<Scalar, 3> operator()(const vector<Scalar, 3>&) const {
    return {Scalar(value.x()), Scalar(value.y()), Scalar(value.z())};
  }
  template <class Scalar>
  [[nodiscard]] field_and_gradient<Scalar> with_gradient(const vector<Scalar, 3>& position) const {
    return {(*this)(position), matrix<Scalar, 3, 3>::Constant(Scalar(0.0))};
  }
};

}  // namespace scifi
