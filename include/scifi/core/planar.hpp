// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/scalar.hpp>

namespace scifi {

/// A vector in the transverse plane as the complex number x + iy: multiplying turns and scales. (std::complex checks for infinities at each product.)
template <scalar Scalar = double>
struct planar {
  Scalar x{};
  Scalar y{};

  friend constexpr planar operator+(const planar& a, const planar& b) { return {a.x + b.x, a.y + b.y}; }
  friend constexpr planar operator-(const planar& a, const planar& b) { return {a.x - b.x, a.y - b.y}; }
  friend constexpr planar operator*(const planar& a, const planar& b) { return {a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x}; }
  friend constexpr planar operator*(const Scalar& f, const planar& a) { return {f * a.x, f * a.y}; }
  constexpr planar& operator+=(const planar& b) { return *this = *this + b; }
  constexpr planar& operator-=(const planar& b) { return *this = *this - b; }
};

/// Mirror image about the x axis.
template <scalar Scalar>
[[nodiscard]] constexpr planar<Scalar> conjugate(const planar<Scalar>& a) {
  return {a.x, -a.y};
}

/// Squared length.
template <scalar Scalar>
[[nodiscard]] constexpr Scalar norm(const planar<Scalar>& a) {
  return a.x * a.x + a.y * a.y;
}

/// Scalar product, Re(conj(a) b).
template <scalar Scalar>
[[nodiscard]] constexpr Scalar dot(const planar<Scalar>& a, const planar<Scalar>& b) {
  return a.x * b.x + a.y * b.y;
}

}  // namespace scifi
