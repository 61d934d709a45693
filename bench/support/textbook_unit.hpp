// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include <scifi/core/linalg.hpp>

#include "support/textbook.hpp"

namespace textbook {

/// The unit of every figure: a textbook step of five components and one measured value, each on its own dense constant matrices.
inline void unit(benchmark::State& state) {
  using square = scifi::matrix<double, 5, 5>;
  std::mt19937_64 engine(51);
  std::normal_distribution<double> normal;
  square f, b;
  scifi::matrix<double, 1, 5> h;
  for (int i = 0; i < 25; ++i) {
    f.data()[i] = normal(engine);
    b.data()[i] = normal(engine);
  }
  for (int i = 0; i < 5; ++i) h(i) = normal(engine);
  f *= 0.95 / f.norm();
  const square q = 0.1 * (b * b.transpose() + square::Identity());
  const scifi::matrix<double, 1, 1> r = scifi::matrix<double, 1, 1>::Constant(1.5);
  constexpr int steps = 64;
  std::vector<scifi::vector<double, 1>> z(steps);
  for (auto& value : z) value(0) = normal(engine);
  for (auto _ : state) {
    knowledge<scifi::vector<double, 5>, square> e{scifi::vector<double, 5>::Zero(), square::Identity()};
    for (const auto& value : z) plain_step(e, f, q, h, r, value);
    benchmark::DoNotOptimize(e);
  }
  state.counters["ns"] = benchmark::Counter(static_cast<double>(state.iterations()) * steps * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

}  // namespace textbook
