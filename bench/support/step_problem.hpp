// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <random>
#include <string>

#include <scifi/core/linalg.hpp>

#include "support/textbook.hpp"

// The filter step that all contenders do: what is given, what must come out, and how long it takes.
namespace stepping {

inline constexpr std::size_t steps = 64;

/// F of spectral radius below one, Q and R of full rank, measured values drawn before the clock.
template <class Scalar, int N, int M>
struct problem {
  scifi::matrix<Scalar, N, N> f, q;
  scifi::matrix<Scalar, M, N> h;
  scifi::matrix<Scalar, M, M> r;
  std::array<scifi::vector<Scalar, M>, steps> z;
};

template <int Rows, int Cols>
scifi::matrix<double, Rows, Cols> drawn(std::mt19937_64& engine) {
  std::normal_distribution<double> normal;
  scifi::matrix<double, Rows, Cols> m;
  for (int j = 0; j < Cols; ++j)
    for (int i = 0; i < Rows; ++i) m(i, j) = normal(engine);
  return m;
}

template <int N, int M>
const problem<double, N, M>& given() {
  static const problem<double, N, M> p = [] {
    std::mt19937_64 engine(N * 10 + M);
    problem<double, N, M> out;
    const scifi::matrix<double, N, N> a = drawn<N, N>(engine);
    out.f = a * (0.95 / a.norm());
    const scifi::matrix<double, N, N> b = drawn<N, N>(engine);
    out.q = 0.1 * (b * b.transpose() + scifi::matrix<double, N, N>::Identity());
    out.h = drawn<M, N>(engine);
    const scifi::matrix<double, M, M> c = drawn<M, M>(engine);
    out.r = c * c.transpose() + scifi::matrix<double, M, M>::Identity();
    for (auto& z : out.z) z = drawn<M, 1>(engine);
    return out;
  }();
  return p;
}

template <int N>
struct answer {
  scifi::vector<double, N> x = scifi::vector<double, N>::Zero();
  scifi::matrix<double, N, N> p = scifi::matrix<double, N, N>::Identity();
  double chi2 = 0.0;
};

/// Joseph's form in extended precision with run-time dimensions.
template <int N, int M>
answer<N> reference(const problem<double, N, M>& g) {
  using matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  using column = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
  const matrix f = g.f.template cast<long double>(), q = g.q.template cast<long double>();
  const matrix h = g.h.template cast<long double>(), r = g.r.template cast<long double>();
  textbook::knowledge<column, matrix> e{column::Zero(N), matrix::Identity(N, N)};
  long double chi2 = 0.0L;
  for (const auto& value : g.z) {
    const column z = value.template cast<long double>();
    const column residual = z - h * f * e.x;
    const matrix s = h * (f * e.p * f.transpose() + q) * h.transpose() + r;
    chi2 += (residual.transpose() * s.inverse() * residual)(0, 0);
    textbook::joseph_step(e, f, q, h, r, z);
  }
  return {e.x.template cast<double>(), e.p.template cast<double>(), static_cast<double>(chi2)};
}

template <int N>
bool agree(const answer<N>& found, const answer<N>& expected, double tolerance, bool has_chi2 = true) {
  const bool chi2_right = !has_chi2 || std::abs(found.chi2 - expected.chi2) <= tolerance * expected.chi2;
  return (found.x - expected.x).norm() <= tolerance * expected.x.norm() && (found.p - expected.p).norm() <= tolerance * expected.p.norm() && chi2_right;
}

/// How many tracks a form takes at once, and how far its results may be off.
template <class Form>
inline constexpr int tracks_of = 1;
template <class Form>
  requires requires { Form::tracks; }
inline constexpr int tracks_of<Form> = Form::tracks;
template <class Form>
inline constexpr double tolerance_of = 1e-11;
template <class Form>
  requires requires { Form::tolerance; }
inline constexpr double tolerance_of<Form> = Form::tolerance;

template <template <int, int> class Form, int N, int M>
bool right() {
  return agree(Form<N, M>::run(given<N, M>()), reference(given<N, M>()), tolerance_of<Form<N, M>>, Form<N, M>::has_chi2);
}

template <template <int, int> class Form, int N, int M>
void timed(benchmark::State& state) {
  const problem<double, N, M>& g = given<N, M>();
  for (auto _ : state) {
    answer<N> a = Form<N, M>::run(g);
    benchmark::DoNotOptimize(a);
  }
  // Shown as ns, one step of one track each.
  state.counters["ns"] = benchmark::Counter(static_cast<double>(state.iterations()) * steps * tracks_of<Form<N, M>> * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

inline bool all_right = true;

template <template <int, int> class Form, int N, int M>
void add(const std::string& form) {
  const std::string name = form + "/" + std::to_string(N) + "x" + std::to_string(M);
  if (!right<Form, N, M>()) {
    std::fprintf(stderr, "%s: the result differs from the reference\n", name.c_str());
    all_right = false;
  }
  benchmark::RegisterBenchmark(name.c_str(), timed<Form, N, M>);
}

}  // namespace stepping
