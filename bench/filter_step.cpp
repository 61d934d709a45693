// SPDX-License-Identifier: MPL-2.0
// One predict and one update with dense constant F, H, Q, R: the library against the textbook's formulae on Eigen matrices.
// Every variant is checked against a reference in extended precision before it is timed; a wrong one ends the program with an error.

#include <benchmark/benchmark.h>

#include <array>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/joseph.hpp>
#include <scifi/kalman/symmetric_form.hpp>

#include "support/textbook.hpp"

namespace {

namespace kalman = scifi::kalman;

constexpr std::size_t steps = 64;

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
struct constant_model {
  const problem<double, N, M>* g;
  const scifi::matrix<double, N, N>& transition(double) const { return g->f; }
  const scifi::matrix<double, N, N>& covariance(double) const { return g->q; }
};

template <int N, int M>
struct measured {
  const problem<double, N, M>* g;
  std::size_t i;
  const scifi::vector<double, M>& value() const { return g->z[i]; }
  const scifi::matrix<double, M, N>& projection() const { return g->h; }
  const scifi::matrix<double, M, M>& covariance() const { return g->r; }
};

template <class Update>
struct library {
  template <int N, int M>
  struct form {
    static constexpr bool has_chi2 = true;
    static answer<N> run(const problem<double, N, M>& g) {
      const constant_model<N, M> model{&g};
      const kalman::filter filter{model, model, Update{}};
      kalman::estimate<double, N> e{answer<N>{}.x, answer<N>{}.p};
      double chi2 = 0.0;
      for (std::size_t i = 0; i < steps; ++i) {
        chi2 += filter.advance(e, 1.0, measured<N, M>{&g, i}).chi2;
      }
      return {e.mean, e.covariance, chi2};
    }
  };
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

template <template <int, int> class Form, int N, int M>
bool right() {
  const answer<N> expected = reference(given<N, M>());
  const answer<N> found = Form<N, M>::run(given<N, M>());
  constexpr double tolerance = 1e-11;
  const bool chi2_right = !Form<N, M>::has_chi2 || std::abs(found.chi2 - expected.chi2) <= tolerance * expected.chi2;
  return (found.x - expected.x).norm() <= tolerance * expected.x.norm() && (found.p - expected.p).norm() <= tolerance * expected.p.norm() && chi2_right;
}

template <template <int, int> class Form, int N, int M>
void timed(benchmark::State& state) {
  const problem<double, N, M>& g = given<N, M>();
  for (auto _ : state) {
    answer<N> a = Form<N, M>::run(g);
    benchmark::DoNotOptimize(a);
  }
  // Shown as ns, one step each.
  state.counters["ns"] = benchmark::Counter(static_cast<double>(state.iterations()) * steps * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

bool all_right = true;

template <template <int, int> class Form, int N, int M>
void add(const std::string& form) {
  const std::string name = form + "/" + std::to_string(N) + "x" + std::to_string(M);
  if (!right<Form, N, M>()) {
    std::fprintf(stderr, "%s: the result differs from the reference\n", name.c_str());
    all_right = false;
  }
  benchmark::RegisterBenchmark(name.c_str(), timed<Form, N, M>);
}

template <int N, int M>
void add_size() {
  add<fixed_plain, N, M>("textbook");
  add<fixed_joseph, N, M>("textbook_joseph");
  add<dynamic_plain, N, M>("textbook_dynamic");
  add<library<kalman::joseph>::form, N, M>("scifi_joseph");
  add<library<kalman::symmetric_form>::form, N, M>("scifi_symmetric");
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
