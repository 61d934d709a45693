// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <type_traits>

#include <scifi/core/scalar.hpp>
#include <scifi/kalman/apply_gate.hpp>
#include <scifi/kalman/updated.hpp>

namespace scifi::kalman {

/// A measurement with one track per SIMD lane that was made in some of the lanes only; in the others its numbers must be finite and do not matter.
///
/// A lane without it keeps its estimate, adds nothing to chi2 and counts no degree of freedom: the update marks it as an outlier.
template <class Measurement, class Mask>
struct in_some_lanes : Measurement {
  Mask where;
  [[nodiscard]] const Mask& present() const { return where; }
};

namespace detail {

/// Puts the prior back in the lanes where nothing was measured.
template <class Measurement, class E, class Outcome>
void keep_absent_lanes(const Measurement& m, const E& prior, E& posterior, Outcome& u) {
  if constexpr (requires { m.present(); }) {
    if (all_of(m.present()) || !u.status.ok()) return;
    keep_where(m.present(), posterior, prior);
    u.outlier = u.outlier || !m.present();
  }
}

}  // namespace detail

}  // namespace scifi::kalman
