// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <string>
#include <vector>

#include "support/step_problem.hpp"

namespace stepping {

template <int N, int M>
struct unit_step {
  static constexpr bool has_chi2 = false;
  static answer<N> run(const problem<double, N, M>& g) {
    textbook::knowledge<scifi::vector<double, N>, scifi::matrix<double, N, N>> e{answer<N>{}.x, answer<N>{}.p};
    for (const auto& z : g.z) textbook::plain_step(e, g.f, g.q, g.h, g.r, z);
    return {e.x, e.p, 0.0};
  }
};

/// Times somebody else's filter beside the textbook's step, in all sizes.
template <template <int, int> class Peer>
int time_peer(const std::string& name, int argc, char** argv) {
  const auto both = [&name]<int N, int M>() {
    add<unit_step, N, M>("textbook");
    add<Peer, N, M>(name);
  };
  both.template operator()<5, 1>();
  both.template operator()<5, 2>();
  both.template operator()<6, 3>();
  both.template operator()<9, 3>();
  if (!all_right) return 1;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace stepping
