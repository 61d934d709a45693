// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <string_view>

namespace scifi {

/// A straight track where it crosses a plane of constant z: position (mm) and slopes against z. Tracker frame.
struct line_state {
  enum component { x, tx, y, ty };
  static constexpr int dimension = 4;
  static constexpr std::array<std::string_view, 4> names{"x", "tx", "y", "ty"};
  static constexpr std::array<std::string_view, 4> units{"mm", "1", "mm", "1"};
  static constexpr std::array<std::string_view, 4> titles{"position x", "slope dx/dz", "position y", "slope dy/dz"};
};

}  // namespace scifi
