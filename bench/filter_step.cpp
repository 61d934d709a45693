// SPDX-License-Identifier: MPL-2.0
// One predict and one update of five components with a one-dimensional measurement: the library against the textbook's formulae.

#include <benchmark/benchmark.h>

#include <Eigen/LU>

#include <scifi/core/linalg.hpp>
#include <scifi/kalman/estimate.hpp>
#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/joseph.hpp>
#include <scifi/kalman/plain.hpp>

namespace {

using state = scifi::vector<double, 5>;
using square = scifi::matrix<double, 5, 5>;
using row = scifi::matrix<double, 1, 5>;

/// Two coordinates with their slopes and a constant, moved by a length.
struct drift {
  square transition(double length) const {
    square f = square::Identity();
    f(0, 1) = f(2, 3) = length;
    return f;
  }
};

struct slope_noise {
  square covariance(double length) const {
    square q = square::Zero();
    q(1, 1) = q(3, 3) = 1.0e-6 * length;
    return q;
  }
};

struct strip {
  double z;
  row h;
  double value() const { return z; }
  double covariance() const { return 0.04; }
  const row& projection() const { return h; }
};

strip next_strip(int i) { return {0.1 * (i % 7), i % 2 == 0 ? row{1.0, 0.0, 0.0, 0.0, 0.0} : row{0.0, 0.0, 1.0, 0.0, 0.0}}; }

const state start_mean = state::Zero();
const square start_covariance = square::Identity();

template <class Update>
void library(benchmark::State& run) {
  const scifi::kalman::filter f{drift{}, slope_noise{}, Update{}};
  for (auto _ : run) {
    scifi::kalman::estimate<double, 5> e{start_mean, start_covariance};
    benchmark::DoNotOptimize(e);
    for (int i = 0; i < 15; ++i) e = f.update(f.predict(e, 10.0), next_strip(i)).posterior;
    benchmark::DoNotOptimize(e);
  }
  run.SetItemsProcessed(run.iterations() * 15);
}

void textbook(benchmark::State& run) {
  for (auto _ : run) {
    state x = start_mean;
    square p = start_covariance;
    benchmark::DoNotOptimize(x);
    benchmark::DoNotOptimize(p);
    for (int i = 0; i < 15; ++i) {
      const square f = drift{}.transition(10.0);
      const strip m = next_strip(i);
      x = f * x;
      p = f * p * f.transpose() + slope_noise{}.covariance(10.0);
      const scifi::matrix<double, 1, 1> s = m.h * p * m.h.transpose() + scifi::matrix<double, 1, 1>::Constant(m.covariance());
      const state k = p * m.h.transpose() * s.inverse();
      x = x + k * (m.z - (m.h * x).value());
      const square a = square::Identity() - k * m.h;
      p = a * p * a.transpose() + k * m.covariance() * k.transpose();
    }
    benchmark::DoNotOptimize(x);
    benchmark::DoNotOptimize(p);
  }
  run.SetItemsProcessed(run.iterations() * 15);
}

}  // namespace

BENCHMARK(textbook);
BENCHMARK(library<scifi::kalman::joseph>);
BENCHMARK(library<scifi::kalman::plain>);
