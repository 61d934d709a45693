// SPDX-License-Identifier: MPL-2.0
#pragma once

namespace scifi::kalman {

/// Accepts every measurement.
struct no_gate {
  template <class Scalar>
  [[nodiscard]] constexpr bool operator()(const Scalar&, int) const {
    return true;
  }
};

/// Accepts a measurement whose chi2 per dimension is at most the given one: 9 is three standard deviations in one dimension.
struct chi2_gate {
  double max_chi2_per_dimension;

  template <class Scalar>
  [[nodiscard]] constexpr auto operator()(const Scalar& chi2, int dimension) const {
    return chi2 <= Scalar(max_chi2_per_dimension * static_cast<double>(dimension));
  }
};

}  // namespace scifi::kalman
