// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>

#include <scifi/core/scalar.hpp>

namespace scifi {

/// Straight lines between neighbours: exact for linear functions, continuous, with a gradient that jumps from cell to cell. Error h^2/8 of the second
/// derivative. The error control of nystrom_propagator sees the kinks and takes shorter steps.
struct linear_interpolation {
  /// Weights of the samples at 0 and 1, for 0 <= t <= 1; samples further out are not asked.
  template <scalar Scalar>
  [[nodiscard]] static std::array<Scalar, 4> weights(const Scalar& t) {
    return {Scalar(0.0), Scalar(Scalar(1.0) - t), t, Scalar(0.0)};
  }
  /// Derivatives of the weights in t.
  template <scalar Scalar>
  [[nodiscard]] static std::array<Scalar, 4> slopes(const Scalar&) {
    return {Scalar(0.0), Scalar(-1.0), Scalar(1.0), Scalar(0.0)};
  }
};

/// Cubic convolution: R. Keys, IEEE Trans. ASSP 29 (1981) 1153, a = -1/2. Exact for parabolas, with a continuous gradient: smooth enough for steps
/// of fourth order to keep their length across cells. Error of third order in h.
struct cubic_interpolation {
  /// Weights of the samples at -1, 0, 1 and 2, for 0 <= t <= 1.
  template <scalar Scalar>
  [[nodiscard]] static std::array<Scalar, 4> weights(const Scalar& t) {
    const Scalar half(0.5), one(1.0), two(2.0);
    return {Scalar(half * t * (t * (two - t) - one)), Scalar(half * (t * t * (Scalar(3.0) * t - Scalar(5.0)) + two)),
            Scalar(half * t * (t * (Scalar(4.0) - Scalar(3.0) * t) + one)), Scalar(half * t * t * (t - one))};
  }
  template <scalar Scalar>
  [[nodiscard]] static std::array<Scalar, 4> slopes(const Scalar& t) {
    const Scalar half(0.5), one(1.0), two(2.0), three(3.0);
    return {Scalar(half * (t * (Scalar(4.0) - three * t) - one)), Scalar(half * t * (Scalar(9.0) * t - Scalar(10.0))),
            Scalar(half * (t * (Scalar(8.0) - Scalar(9.0) * t) + one)), Scalar(half * t * (three * t - two))};
  }
};

}  // namespace scifi
