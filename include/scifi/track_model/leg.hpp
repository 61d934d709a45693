// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/material/slab.hpp>

namespace scifi {

/// One step of a track between two surfaces of constant z, with the material on the way. The step type of the propagators with material.
///
/// Thin material right behind the first surface, flight by dz through `gap` (a thick layer that fills dz, usually gas), thin material
/// right before the second surface. Stacks are in any order: only their sums act. dz counts the whole distance, thin material included.
struct leg {
  double dz = 0.0;       ///< signed distance, mm; the sign tells the direction of the step, not of the particle
  int direction = 1;     ///< +1 or -1: direction of the step in z, needed where dz = 0
  slab_stack<4> start;   ///< thin, at the first surface
  slab_stack<1> gap;     ///< thick, spread over dz
  slab_stack<4> finish;  ///< thin, at the second surface
  double z = 0.0;        ///< where the first surface is, mm; asked by propagators in a field that changes along z, not by others
};

}  // namespace scifi
