// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <string>

#include <scifi/core/units.hpp>
#include <scifi/field/field_map.hpp>

namespace scifi {

namespace detail {

/// The shortest decimal that reads back as the same number.
inline void append_shortest(std::string& out, double x) {
  std::array<char, 32> digits{};
  out.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), x).ptr);
}

template <class... Numbers>
void append_row(std::string& out, double first, Numbers... more) {
  append_shortest(out, first);
  ((out += ' ', append_shortest(out, more)), ...);
  out += '\n';
}

}  // namespace detail

/// A map as the text that `read_field_map` reads: all its points, in mm and tesla, without symmetry.
[[nodiscard]] inline std::string field_map_to_text(const cylindrical_map<>& map) {
  std::string out = "scifi field map\ngrid cylindrical\nlength mm\nfield T\ncolumns r z br bz\n";
  for (std::size_t i = 0; i < map.r().count; ++i)
    for (std::size_t k = 0; k < map.z().count; ++k) {
      const auto& b = map.at(i, k);
      detail::append_row(out, map.r().at(i), map.z().at(k), b[0] / units::tesla, b[1] / units::tesla);
    }
  return out;
}

/// The same for a Cartesian one.
[[nodiscard]] inline std::string field_map_to_text(const cartesian_map<>& map) {
  std::string out = "scifi field map\ngrid cartesian\nlength mm\nfield T\ncolumns x y z bx by bz\n";
  const auto& [x, y, z] = map.axes();
  for (std::size_t i = 0; i < x.count; ++i)
    for (std::size_t j = 0; j < y.count; ++j)
      for (std::size_t k = 0; k < z.count; ++k) {
        const auto& b = map.at({i, j, k});
        detail::append_row(out, x.at(i), y.at(j), z.at(k), b[0] / units::tesla, b[1] / units::tesla, b[2] / units::tesla);
      }
  return out;
}

[[nodiscard]] inline std::string field_map_to_text(const field_map& map) {
  return std::visit([](const auto& m) { return field_map_to_text(m); }, map.map());
}

}  // namespace scifi
