// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <string_view>

namespace scifi {

/// A bent track where it crosses a plane of constant z: position, slopes, charge over longitudinal momentum. Tracker frame.
///
/// The track fit works in these: a straight line is the smooth limit q/pz -> 0, scattering acts on the slopes alone, and energy loss
/// on q/pz alone. q/pz = charge / pz keeps the sign of pz: a positive particle that travels towards -z has a negative q/pz.
struct slope_state {
  enum component { x, tx, y, ty, q_over_pz };
  static constexpr int dimension = 5;
  static constexpr std::array<std::string_view, 5> names{"x", "tx", "y", "ty", "q_over_pz"};
  static constexpr std::array<std::string_view, 5> units{"mm", "1", "mm", "1", "e/(MeV/c)"};
  static constexpr std::array<std::string_view, 5> titles{"position x", "slope dx/dz", "position y", "slope dy/dz", "charge over longitudinal momentum"};
};

}  // namespace scifi
