// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <scifi/core/linalg.hpp>
#include <scifi/field/cartesian_map.hpp>
#include <scifi/field/concepts.hpp>
#include <scifi/field/cylindrical_map.hpp>

namespace scifi {

/// A map of a field that is the same all round the z axis, from its values on the half-plane y = 0, x >= 0. `r` begins with 0.
template <class Interpolation = cubic_interpolation, magnetic_field Field>
[[nodiscard]] cylindrical_map<Interpolation> tabulated(const Field& field, const grid_axis& r, const grid_axis& z, outside_map outside) {
  std::vector<std::array<double, 2>> values;
  values.reserve(r.count * z.count);
  for (std::size_t i = 0; i < r.count; ++i)
    for (std::size_t k = 0; k < z.count; ++k) {
      const vector<double, 3> b = field(vector<double, 3>(r.at(i), 0.0, z.at(k)));
      values.push_back({i == 0 ? 0.0 : b.x(), b.z()});
    }
  return cylindrical_map<Interpolation>(r, z, values, outside);
}

/// A map of any field.
template <class Interpolation = cubic_interpolation, magnetic_field Field>
[[nodiscard]] cartesian_map<Interpolation> tabulated(const Field& field, const grid_axis& x, const grid_axis& y, const grid_axis& z, outside_map outside) {
  std::vector<std::array<double, 3>> values;
  values.reserve(x.count * y.count * z.count);
  for (std::size_t i = 0; i < x.count; ++i)
    for (std::size_t j = 0; j < y.count; ++j)
      for (std::size_t k = 0; k < z.count; ++k) {
        const vector<double, 3> b = field(vector<double, 3>(x.at(i), y.at(j), z.at(k)));
        values.push_back({b.x(), b.y(), b.z()});
      }
  return cartesian_map<Interpolation>(x, y, z, values, outside);
}

}  // namespace scifi
