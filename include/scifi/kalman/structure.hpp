// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>

#include <scifi/core/linalg.hpp>

/// Structure that models declare of their matrices at compile time, so that nothing is multiplied by zeros and ones.
///
/// A propagator: `static constexpr std::array unit_columns{...}`, the columns of its Jacobian that are those of the identity for every state and step; a
/// position that nothing but its own place depends on has such a column. A measurement: `static constexpr std::array seen_components{...}`, the
/// components of the state that its projection has entries for; all others are taken to be zero. What is not declared is taken to be dense.
namespace scifi::kalman {

/// The declaration of a propagator, for another one to pass on; an empty list where it has none.
template <class Propagator>
inline constexpr auto unit_columns = [] {
  if constexpr (requires { Propagator::unit_columns; }) return Propagator::unit_columns;
  else return std::array<int, 0>{};
}();

namespace detail {

/// One bit for each entry of a list of columns.
template <class Columns>
[[nodiscard]] consteval unsigned bits_of(const Columns& columns) {
  unsigned bits = 0;
  for (const auto c : columns) bits |= 1u << static_cast<unsigned>(c);
  return bits;
}

template <class Propagator>
[[nodiscard]] consteval unsigned unit_columns_of() {
  return bits_of(unit_columns<Propagator>);
}

template <class Measurement>
[[nodiscard]] consteval unsigned seen_components_of() {
  if constexpr (requires { Measurement::seen_components; }) return bits_of(Measurement::seen_components);
  else return ~0u;
}

[[nodiscard]] constexpr bool has_bit(unsigned bits, int i) { return ((bits >> i) & 1u) != 0; }

/// Makes the columns of a Jacobian whose bit is set those of the identity.
template <unsigned Unit, class Scalar, int N>
[[gnu::always_inline]] inline void set_unit_columns(matrix<Scalar, N, N>& jacobian) {
  for (int j = 0; j < N; ++j)
    for (int i = 0; i < N; ++i)
      if (has_bit(Unit, j)) jacobian(i, j) = Scalar(i == j ? 1.0 : 0.0);
}

}  // namespace detail

}  // namespace scifi::kalman
