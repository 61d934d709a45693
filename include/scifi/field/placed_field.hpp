// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/linalg.hpp>
#include <scifi/field/concepts.hpp>

namespace scifi {

/// A field given in one frame, asked in another: B(r) = R' B_inner(R r + t), with the position and all vectors turned back.
template <class Field>
struct placed_field {
  Field inner;
  matrix<double, 3, 3> outer_to_inner = matrix<double, 3, 3>::Identity();  ///< R: rotation of directions
  vector<double, 3> origin = vector<double, 3>::Zero();                    ///< t: where the origin of the outer frame is in the inner one, mm

  template <class Scalar>
    requires magnetic_field<Field, Scalar>
  [[nodiscard]] vector<Scalar, 3> operator()(const vector<Scalar, 3>& position) const {
    const matrix<Scalar, 3, 3> turn = outer_to_inner.template cast<Scalar>();
    return turn.transpose() * inner(moved(position, turn));
  }

  template <class Scalar>
    requires magnetic_field_with_gradient<Field, Scalar>
  [[nodiscard]] field_and_gradient<Scalar> with_gradient(const vector<Scalar, 3>& position) const {
    const matrix<Scalar, 3, 3> turn = outer_to_inner.template cast<Scalar>();
    const field_and_gradient<Scalar> b = inner.with_gradient(moved(position, turn));
    return {turn.transpose() * b.value, turn.transpose() * b.gradient * turn};
  }

 private:
  template <class Scalar>
  [[nodiscard]] vector<Scalar, 3> moved(const vector<Scalar, 3>& position, const matrix<Scalar, 3, 3>& turn) const {
    return turn * position + origin.template cast<Scalar>();
  }
};

template <class Field, class... Where>
placed_field(Field, Where...) -> placed_field<Field>;

}  // namespace scifi
