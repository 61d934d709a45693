// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>

#include <scifi/field/field_map.hpp>
#include <scifi/io/field_map_grid.hpp>
#include <scifi/io/field_map_text.hpp>
#include <scifi/io/input_error.hpp>

namespace scifi {

/// The field map in a text file, plain or gzip, in the format of docs/field_maps.md: a cylindrical or a Cartesian grid with its units and symmetry.
///
/// `outside` says what there is beyond the grid. Between its points the map is interpolated by cubic convolution (cubic_interpolation).
/// Throws input_error with file, line, key or column, and the reason, for whatever does not fit.
[[nodiscard]] inline field_map read_field_map(const std::filesystem::path& path, outside_map outside) {
  const detail::field_map_text text(path);
  if (!text.cylindrical) {
    const detail::field_map_grid<3> grid(text);
    return field_map(cartesian_map<>(grid.axes[0], grid.axes[1], grid.axes[2], grid.values, outside));
  }
  detail::field_map_grid<2> grid(text);
  if (std::abs(grid.axes[0].first) > 1e-3 * grid.axes[0].step) throw input_error(text.file(), 0, "r", "the grid does not begin with 0");
  grid.axes[0].first = 0.0;
  double largest = 0.0;
  for (const std::array<double, 2>& v : grid.values) largest = std::max({largest, std::abs(v[0]), std::abs(v[1])});
  constexpr double rounding = 1e-6;  // of the largest field
  for (std::size_t i = 0; i < grid.axes[1].count; ++i) {
    if (std::abs(grid.values[i][0]) > rounding * largest) throw input_error(text.file(), 0, "br", "is not zero on the axis");
    grid.values[i][0] = 0.0;
  }
  return field_map(cylindrical_map<>(grid.axes[0], grid.axes[1], grid.values, outside));
}

}  // namespace scifi
