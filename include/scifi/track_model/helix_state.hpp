// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <string_view>

namespace scifi {

/// A bent track where it crosses a plane of constant z: position, transverse momentum, charge over longitudinal momentum. Tracker frame.
///
/// The transverse momentum is a vector that the solenoid field turns. Valid for q/pz != 0; see slope_state for the form without that limit.
struct helix_state {
  enum component { x, px, y, py, q_over_pz };
  static constexpr int dimension = 5;
  static constexpr std::array<std::string_view, 5> names{"x", "px", "y", "py", "q_over_pz"};
  static constexpr std::array<std::string_view, 5> units{"mm", "MeV/c", "mm", "MeV/c", "e/(MeV/c)"};
  static constexpr std::array<std::string_view, 5> titles{"position x", "momentum x", "position y", "momentum y", "charge over longitudinal momentum"};
};

/// Position in the plane of constant z and the three components of momentum; the charge goes beside it. Tracker frame.
struct momentum_state {
  enum component { x, y, px, py, pz };
  static constexpr int dimension = 5;
  static constexpr std::array<std::string_view, 5> names{"x", "y", "px", "py", "pz"};
  static constexpr std::array<std::string_view, 5> units{"mm", "mm", "MeV/c", "MeV/c", "MeV/c"};
  static constexpr std::array<std::string_view, 5> titles{"position x", "position y", "momentum x", "momentum y", "momentum z"};
};

}  // namespace scifi
