// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <concepts>

#include <scifi/core/linalg.hpp>

namespace scifi {

/// A magnetic field and how it changes in space: gradient(i, j) = dB_i / dr_j, in (MeV/c)/(e mm) and that per mm.
template <class Scalar>
struct field_and_gradient {
  vector<Scalar, 3> value;
  matrix<Scalar, 3, 3> gradient;
};

namespace detail {

/// A column of three of these numbers. (Eigen's own conversions would let a field of doubles pass for one of floats, and fail later.)
template <class T, class Scalar>
concept three_of = std::same_as<typename T::Scalar, Scalar> && T::RowsAtCompileTime == 3 && T::ColsAtCompileTime == 1;

}  // namespace detail

/// f(position) gives B in (MeV/c)/(e mm), tesla times units::tesla, at a position in mm; both in the same frame, usually that of a tracker.
/// Law: div B = 0, and curl B = 0 where no current flows; const, shared by threads. Where it is not known it says NaN, and never throws.
template <class F, class Scalar = double>
concept magnetic_field = requires(const F& f, const vector<Scalar, 3>& position) {
  { f(position) } -> detail::three_of<Scalar>;
};

/// A field that also offers f.with_gradient(position). Law: the gradient is the derivative of the value.
template <class F, class Scalar = double>
concept magnetic_field_with_gradient = magnetic_field<F, Scalar> && requires(const F& f, const vector<Scalar, 3>& position) {
  { f.with_gradient(position) } -> std::same_as<field_and_gradient<Scalar>>;
};

}  // namespace scifi
