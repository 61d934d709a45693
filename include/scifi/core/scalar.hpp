// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <concepts>
#include <limits>

namespace scifi {

/// What the numerical core needs of a number: arithmetic and a conversion from double.
/// Law: operations act on each lane (or derivative) on its own. Models: float, double, Eigen::AutoDiffScalar, a SIMD pack.
/// Square root, sine, logarithm ... are found by argument-dependent lookup after `using std::sqrt`.
template <class T>
concept scalar = requires(T a, const T b) {
  T(1.0);
  T(a + b);
  T(a - b);
  T(a * b);
  T(a / b);
  T(-b);
  a < b;
};

/// `condition ? a : b`, lane by lane: packs overload it with a blend. Both sides are evaluated, so guard denominators before.
template <class T>
[[nodiscard]] constexpr T select(bool condition, const T& a, const T& b) {
  return condition ? a : b;
}

/// True where the condition holds in every lane; for a plain scalar the condition itself.
[[nodiscard]] constexpr bool all_of(bool condition) { return condition; }

/// True where the condition holds in any lane; for a plain scalar the condition itself.
[[nodiscard]] constexpr bool any_of(bool condition) { return condition; }

/// Finite (neither NaN nor infinite), lane by lane; written so that it needs nothing but arithmetic and comparison.
template <scalar T>
[[nodiscard]] constexpr auto is_finite(const T& x) {
  return T(x - x) >= T(0.0);  // zero or NaN
}

/// The larger of two numbers, lane by lane.
template <scalar T>
[[nodiscard]] constexpr T larger_of(const T& a, const T& b) {
  return select(a < b, b, a);
}

/// The smaller of two numbers, lane by lane.
template <scalar T>
[[nodiscard]] constexpr T smaller_of(const T& a, const T& b) {
  return select(b < a, b, a);
}

/// Absolute value, lane by lane, with the derivative of |x| for dual numbers.
template <scalar T>
[[nodiscard]] constexpr T magnitude(const T& x) {
  return select(x < T(0.0), T(-x), x);
}

/// x squared.
template <scalar T>
[[nodiscard]] constexpr T square(const T& x) {
  return x * x;
}

}  // namespace scifi
