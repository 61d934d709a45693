// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <utility>

namespace scifi::kalman::detail {

/// f(i) for i from 0 to N - 1, written out where N is small: g++ keeps loops in triangles rolled, and their matrices in memory.
template <int N, class F>
[[gnu::always_inline]] inline void each_index(const F& f) {
  constexpr int most_unrolled = 3;
  if constexpr (N <= most_unrolled) {
    [&f]<int... I>(std::integer_sequence<int, I...>) __attribute__((always_inline)) { (f(I), ...); }(std::make_integer_sequence<int, N>{});
  } else {
    for (int i = 0; i < N; ++i) f(i);
  }
}

}  // namespace scifi::kalman::detail
