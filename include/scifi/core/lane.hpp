// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <type_traits>

#include <scifi/core/pack.hpp>

namespace scifi {

namespace detail {

template <class Scalar>
struct one_lane {
  using type = Scalar;
};
template <class T, int Lanes>
struct one_lane<pack<T, Lanes>> {
  using type = T;
};

}  // namespace detail

/// How many tracks a scalar stands for: the lanes of a pack, one for any other number.
template <class Scalar>
inline constexpr int lane_count = 1;
template <class T, int Lanes>
inline constexpr int lane_count<pack<T, Lanes>> = Lanes;

/// The type of the number in one lane.
template <class Scalar>
using lane_type = typename detail::one_lane<Scalar>::type;

/// The number, or truth value, in one lane; of a plain one itself.
template <class T>
[[nodiscard]] auto lane_of(const T& x, int lane) {
  if constexpr (requires { x[lane]; }) return x[lane];
  else return x;
}

/// Sets the number, or truth value, of one lane.
template <class T, class Value>
void set_lane(T& x, int lane, const Value& value) {
  if constexpr (requires { typename T::value_type; }) x.set(lane, static_cast<typename T::value_type>(value));
  else if constexpr (requires { x.set(lane, value); }) x.set(lane, value);
  else x = static_cast<T>(value);
}

}  // namespace scifi
