// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>

#include <scifi/core/scalar.hpp>

namespace scifi {

/// What a map says of places that it does not cover.
enum class outside_map {
  zero,     ///< there is no field
  nearest,  ///< that at the nearest place on its edge
  error,    ///< nothing: NaN, with which a flight ends as `no_field`
};

/// Points at equal distances along one coordinate.
struct grid_axis {
  double first = 0.0;  ///< mm
  double step = 1.0;   ///< mm, > 0
  std::size_t count = 2;

  [[nodiscard]] double at(std::size_t i) const { return first + step * static_cast<double>(i); }
  [[nodiscard]] double last() const { return at(count - 1); }
};

/// A scalar that stands for one number: one that has a place in a table. A double, a float, a dual number; not a pack of lanes.
template <class Scalar>
concept single_number = scalar<Scalar> && (std::convertible_to<Scalar, double> || requires(const Scalar& x) { x.value(); });

/// The number without its derivatives.
template <single_number Scalar>
[[nodiscard]] double number_of(const Scalar& x) {
  if constexpr (std::convertible_to<Scalar, double>) return static_cast<double>(x);
  else return number_of(x.value());
}

/// Where a coordinate lies on an axis.
template <class Scalar>
struct grid_place {
  std::size_t cell = 0;   ///< between point `cell` and the next
  Scalar fraction{};      ///< of the cell, 0..1
  bool inside = true;     ///< false: fraction belongs to the nearest edge
};

/// The cell of a coordinate. What lies outside by a rounding is inside; NaN has a fraction of NaN, so that no field is read off there.
template <single_number Scalar>
[[nodiscard]] grid_place<Scalar> place_on(const grid_axis& axis, const Scalar& x) {
  constexpr double rounding = 1e-9;  // of a cell
  const Scalar along = (x - Scalar(axis.first)) * Scalar(1.0 / axis.step);
  const double number = number_of(along);
  const auto cells = static_cast<double>(axis.count - 1);
  if (std::isnan(number)) return {0, along, true};
  if (number < 0.0) return {0, Scalar(0.0), number > -rounding};
  if (!(number < cells)) return {axis.count - 2, Scalar(1.0), number < cells + rounding};
  const double cell = std::floor(number);
  return {static_cast<std::size_t>(cell), Scalar(along - Scalar(cell)), true};
}

}  // namespace scifi
