// SPDX-License-Identifier: MPL-2.0
// One predict and one update with dense constant F, H, Q, R: the library against the textbook's formulae on Eigen matrices.
// Every variant is checked against a reference in extended precision before it is timed; a wrong one ends the program with an error.

#include <benchmark/benchmark.h>

#include <vector>

#include <scifi/kalman/joseph.hpp>
#include <scifi/kalman/symmetric_form.hpp>

#include "support/library_step.hpp"
#include "support/step_problem.hpp"
#include "support/textbook.hpp"

namespace {

namespace kalman = scifi::kalman;
using namespace stepping;

template <int N, int M>
struct fixed_plain {
  static constexpr bool has_chi2 = false;
  static answer<N> run(const problem<double, N, M>& g) {
    textbook::knowledge<scifi::vector<double, N>, scifi::matrix<double, N, N>> e{answer<N>{}.x, answer<N>{}.p};
    for (const auto& z : g.z) textbook::plain_step(e, g.f, g.q, g.h, g.r, z);
    return {e.x, e.p, 0.0};
  }
};

template <int N, int M>
struct fixed_joseph {
  static constexpr bool has_chi2 = false;
  static answer<N> run(const problem<double, N, M>& g) {
    textbook::knowledge<scifi::vector<double, N>, scifi::matrix<double, N, N>> e{answer<N>{}.x, answer<N>{}.p};
    for (const auto& z : g.z) textbook::joseph_step(e, g.f, g.q, g.h, g.r, z);
    return {e.x, e.p, 0.0};
  }
};

template <int N, int M>
struct dynamic_plain {
  static constexpr bool has_chi2 = false;
  static answer<N> run(const problem<double, N, M>& g) {
    static const Eigen::MatrixXd f = g.f, q = g.q, h = g.h, r = g.r;
    static const std::vector<Eigen::VectorXd> measured(g.z.begin(), g.z.end());
    textbook::knowledge<Eigen::VectorXd, Eigen::MatrixXd> e{answer<N>{}.x, answer<N>{}.p};
    for (const auto& z : measured) textbook::plain_step(e, f, q, h, r, z);
    return {e.x, e.p, 0.0};
  }
};

template <int N, int M>
void add_size() {
  add<fixed_plain, N, M>("textbook");
  add<fixed_joseph, N, M>("textbook_joseph");
  add<dynamic_plain, N, M>("textbook_dynamic");
  add<library<kalman::joseph>::form, N, M>("scifi_joseph");
  add<library<kalman::symmetric_form>::form, N, M>("scifi_symmetric");
  add_lanes<scifi::pack<double>, N, M>("scifi_lanes");
  add_lanes<scifi::pack<float>, N, M>("scifi_floats");
}

}  // namespace

int main(int argc, char** argv) {
  add_size<5, 1>();
  add_size<5, 2>();
  add_size<6, 3>();
  add_size<9, 3>();
  if (!all_right) return 1;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
