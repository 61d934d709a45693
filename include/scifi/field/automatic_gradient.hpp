// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include <scifi/core/linalg.hpp>
#include <scifi/field/concepts.hpp>

namespace scifi {

/// A field with its gradient from dual numbers, exact to rounding, for one that is a template in its scalar; costs about four evaluations.
template <class Field>
struct automatic_gradient {
  Field field;

  template <class Scalar>
    requires magnetic_field<Field, Scalar>
  [[nodiscard]] vector<Scalar, 3> operator()(const vector<Scalar, 3>& position) const {
    return field(position);
  }

  template <class Scalar>
    requires magnetic_field<Field, Eigen::AutoDiffScalar<vector<Scalar, 3>>>
  [[nodiscard]] field_and_gradient<Scalar> with_gradient(const vector<Scalar, 3>& position) const {
    using dual = Eigen::AutoDiffScalar<vector<Scalar, 3>>;
    vector<dual, 3> at;
    for (int i = 0; i < 3; ++i) at[i] = dual(position[i], 3, i);
    const vector<dual, 3> b = field(at);
    field_and_gradient<Scalar> out;
    for (int i = 0; i < 3; ++i) {
      out.value[i] = b[i].value();
      out.gradient.row(i) = b[i].derivatives().transpose();
    }
    return out;
  }
};

template <class Field>
automatic_gradient(Field) -> automatic_gradient<Field>;

}  // namespace scifi
