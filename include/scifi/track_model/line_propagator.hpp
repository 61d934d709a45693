// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>

#include <scifi/core/linalg.hpp>
#include <scifi/track_model/line_state.hpp>

namespace scifi {

/// Straight flight by dz (mm, either sign): x' = x + dz tx, y' = y + dz ty. Exact; linear, so the transition matrix says all.
struct line_propagator {
  using state_space = line_state;
  static constexpr std::array unit_columns{line_state::x, line_state::y};

  /// The 4 x 4 transition matrix of line_state over dz mm.
  [[nodiscard]] matrix<double, 4, 4> transition(double dz) const {
    matrix<double, 4, 4> f = matrix<double, 4, 4>::Identity();
    f(line_state::x, line_state::tx) = dz;
    f(line_state::y, line_state::ty) = dz;
    return f;
  }
};

}  // namespace scifi
