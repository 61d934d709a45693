// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <scifi/core/linalg.hpp>

namespace scifi::test {

/// Derivatives of a field by central differences of fourth order.
struct differences {
  matrix<double, 3, 3> gradient;  ///< dB_i / dr_j
  [[nodiscard]] double divergence() const { return gradient.trace(); }
  [[nodiscard]] vector<double, 3> curl() const {
    return {gradient(2, 1) - gradient(1, 2), gradient(0, 2) - gradient(2, 0), gradient(1, 0) - gradient(0, 1)};
  }
};

/// f' = (8 (f(h) - f(-h)) - f(2h) + f(-2h)) / 12h; the error is h^4/30 of the fifth derivative (Abramowitz and Stegun 25.3.24).
template <class Field>
[[nodiscard]] differences differences_of(const Field& field, const vector<double, 3>& at, double h) {
  differences out;
  for (int j = 0; j < 3; ++j) {
    const vector<double, 3> step = h * vector<double, 3>::Unit(j);
    const auto f = [&](double n) { return vector<double, 3>(field(vector<double, 3>(at + n * step))); };
    out.gradient.col(j) = (8.0 * (f(1.0) - f(-1.0)) - f(2.0) + f(-2.0)) / (12.0 * h);
  }
  return out;
}

}  // namespace scifi::test
