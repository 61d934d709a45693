// SPDX-License-Identifier: MPL-2.0
// The filter step with one track a lane on the library's own pack and on std::experimental::simd, at the same width: which is the scalar, one alias says.
// What the library asks of a scalar that the standard's type has not, a header of the user's gives before any other: `select`, and Eigen's traits.

#include <experimental/simd>

namespace scifi {

template <class T, class Abi>
[[nodiscard, gnu::always_inline]] inline std::experimental::simd<T, Abi> select(const std::experimental::simd_mask<T, Abi>& m, const std::experimental::simd<T, Abi>& a, const std::experimental::simd<T, Abi>& b) {
  std::experimental::simd<T, Abi> out = b;
  where(m, out) = a;
  return out;
}

}  // namespace scifi

#include <scifi/core/lane.hpp>

#include "support/library_step.hpp"

namespace {

using own = scifi::pack<double>;
using standard = std::experimental::native_simd<double>;

}  // namespace

template <class T, class Abi>
struct Eigen::NumTraits<std::experimental::simd<T, Abi>> : Eigen::GenericNumTraits<T> {
  using Real = std::experimental::simd<T, Abi>;
  using NonInteger = Real;
  using Literal = T;
  using Nested = Real;
};

template <class T, class Abi>
inline constexpr int scifi::lane_count<std::experimental::simd<T, Abi>> = static_cast<int>(std::experimental::simd_size_v<T, Abi>);

int main(int argc, char** argv) {
  static_assert(scifi::lane_count<standard> == scifi::lane_count<own>, "both fill a register");
  stepping::add_lanes<own, 5, 1>("pack");
  stepping::add_lanes<standard, 5, 1>("std_simd");
  if (!stepping::all_right) return 1;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
