// SPDX-License-Identifier: MPL-2.0
#pragma once

namespace laws {

/// True where a gate that accepts some chi2 accepts every smaller one, tried at 1000 places up to `largest`.
template <class Gate>
bool gate_is_monotone(const Gate& gate, int dimension, double largest) {
  bool before = true;
  for (int i = 0; i <= 1000; ++i) {
    const bool now = gate(largest * static_cast<double>(i) / 1000.0, dimension);
    if (now && !before) return false;
    before = now;
  }
  return true;
}

}  // namespace laws
