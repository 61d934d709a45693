// SPDX-License-Identifier: MPL-2.0
// The laws of an update, asked of every form alike on random linear problems.
#include "support/catch.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <scifi/core/pack.hpp>
#include <scifi/kalman/iterated.hpp>
#include <scifi/kalman/plain.hpp>
#include <scifi/kalman/square_root.hpp>
#include <scifi/kalman/symmetric_form.hpp>

#include "unit/kalman/batch.hpp"
#include "unit/kalman/dense.hpp"

namespace kalman = scifi::kalman;
using dense::knowledge;
using dense::matrix;
using dense::observation;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// A linear measurement that does not say so: `iterated` has to find out.
template <int N, int M>
struct projected_values {
  models::linear_values<N, M> of;
  const scifi::vector<double, M>& value() const { return of.z; }
  const scifi::matrix<double, M, M>& covariance() const { return of.r; }
  kalman::projected<double, M, N> project(const scifi::vector<double, N>& x) const { return {of.h.lazyProduct(x), of.h}; }
};

/// What an update makes of knowledge and one observation.
struct outcome {
  knowledge posterior;
  double chi2;
  bool ok;
};
using update = std::function<outcome(const knowledge&, const observation&)>;

/// An update policy for N components and M numbers behind matrices of any size, so that what is asked of it is compiled once for all shapes.
template <int N, int M, class Policy>
[[gnu::noinline]] outcome apply(const Policy& policy, const knowledge& prior, const observation& o) {
  const auto u = policy(dense::fixed_estimate<N>(prior), dense::fixed_values<N, M>(o));
  return {dense::knowledge_of(u.posterior), u.chi2, u.status.ok()};
}
template <int N, int M>
[[gnu::noinline]] outcome apply(const kalman::iterated<>& policy, const knowledge& prior, const observation& o) {
  const auto u = policy(dense::fixed_estimate<N>(prior), projected_values<N, M>{dense::fixed_values<N, M>(o)});
  return {dense::knowledge_of(u.posterior), u.chi2, u.status.ok()};
}
/// In packs: the problem in the last lane, others in the lanes before.
struct in_packs {};
template <int N, int M>
[[gnu::noinline]] outcome apply(const in_packs&, const knowledge& prior, const observation& o) {
  using pack = scifi::pack<double, 2>;
  const auto widen = [](double x) {
    pack p(0.3 * x);
    p.set(1, x);
    return p;
  };
  kalman::estimate<pack, N> e;
  kalman::linear_measurement<pack, N, M> m;
  for (int i = 0; i < N; ++i) e.mean(i) = widen(prior.mean(i));
  for (int i = 0; i < N * N; ++i) e.covariance.data()[i] = widen(prior.covariance.data()[i]);
  for (int i = 0; i < M; ++i) m.z(i) = widen(o.z(i));
  for (int i = 0; i < M * N; ++i) m.h.data()[i] = widen(o.h.data()[i]);
  for (int i = 0; i < M * M; ++i) m.r.data()[i] = widen(o.r.data()[i]);
  const auto u = kalman::joseph{}(e, m);
  kalman::estimate<double, N> last;
  for (int i = 0; i < N; ++i) last.mean(i) = u.posterior.mean(i)[1];
  for (int i = 0; i < N * N; ++i) last.covariance.data()[i] = u.posterior.covariance.data()[i][1];
  return {dense::knowledge_of(last), u.chi2[1], u.status.ok()};
}

template <int N, int M, class Policy>
update updating(const Policy& policy) {
  return [policy](const knowledge& prior, const observation& o) { return apply<N, M>(policy, prior, o); };
}

/// What is known before, and two independent observations of it.
struct problem {
  knowledge prior;
  observation a, b;
};

problem random_problem(std::mt19937_64& engine, int n, int m) {
  return {dense::random_knowledge(engine, n), dense::random_observation(engine, n, m), dense::random_observation(engine, n, m)};
}

/// The problem in another frame of the state, x -> t x, and of its observations, z -> u z.
problem transformed(const problem& p, const matrix& t, const matrix& inverse, const matrix& u) {
  const auto seen = [&](const observation& o) { return observation{u * o.z, u * o.h * inverse, dense::symmetric(u * o.r * u.transpose())}; };
  return {{t * p.prior.mean, dense::symmetric(t * p.prior.covariance * t.transpose())}, seen(p.a), seen(p.b)};
}

/// The answer by least squares over all rows at once, and how far rounding may carry an update from it in units of its standard deviations: S is
/// solved for with eps cond(S), its result of the size of P (and of the mean's way) is taken from P, and measured by the smallest variance left.
struct answer {
  knowledge posterior;
  double chi2, tolerance;
};

answer by_least_squares(const problem& p) {
  const int n = static_cast<int>(p.prior.mean.size());
  models::batch all(1, n);
  all.add(0, matrix::Identity(n, n), p.prior.mean, p.prior.covariance);
  all.add(0, p.a.h, p.a.z, p.a.r);
  all.add(0, p.b.h, p.b.z, p.b.r);
  all.solve();
  const knowledge k{all.mean(0), all.covariance(0)};
  const auto condition = [&](const observation& o) {
    const auto [least, most] = dense::extreme_eigenvalues(o.h * p.prior.covariance * o.h.transpose() + o.r);
    return most / least;
  };
  const double before = dense::extreme_eigenvalues(p.prior.covariance).second, left = dense::extreme_eigenvalues(k.covariance).first;
  const double way = p.prior.mean.cwiseAbs().maxCoeff() + k.mean.cwiseAbs().maxCoeff();
  return {k, all.chi2(), 64.0 * eps * std::max(condition(p.a), condition(p.b)) * std::max(before / left, way / std::sqrt(left))};
}

/// Both observations taken in, and chi2 of both.
outcome after(const update& f, const knowledge& prior, const observation& a, const observation& b) {
  const outcome first = f(prior, a);
  outcome second = f(first.posterior, b);
  REQUIRE(first.ok);
  REQUIRE(second.ok);
  second.chi2 += first.chi2;
  return second;
}

void check_update(const update& f, int n, int m, std::mt19937_64& engine) {
  INFO(n << " components and " << m << " measured numbers");
  const problem p = random_problem(engine, n, m);
  const answer expected = by_least_squares(p);
  const double tolerance = expected.tolerance;
  REQUIRE(tolerance < 1e-6);
  const auto same = [&](const outcome& u) {
    CHECK(dense::distance(expected.posterior, u.posterior) < tolerance);
    CHECK(u.chi2 == Approx(expected.chi2).epsilon(tolerance).margin(tolerance));
  };
  const outcome posterior = after(f, p.prior, p.a, p.b);
  same(posterior);
  same(after(f, p.prior, p.b, p.a));

  // Another frame of the state and another of what is measured: the answer turns with them.
  const matrix t = dense::random_rotation(engine, n), u = dense::random_rotation(engine, m);
  const problem turned = transformed(p, t, t.transpose(), u);
  outcome back = after(f, turned.prior, turned.a, turned.b);
  back.posterior = {t.transpose() * back.posterior.mean, t.transpose() * back.posterior.covariance * t};
  same(back);

  // Other units, powers of two apart so that nothing is rounded: the same to the last bit.
  matrix units = matrix::Identity(n, n), measured_units = matrix::Identity(m, m);
  for (int i = 0; i < n; ++i) units(i, i) = std::ldexp(1.0, 7 * i - 20);
  for (int i = 0; i < m; ++i) measured_units(i, i) = std::ldexp(1.0, 11 - 5 * i);
  const problem rescaled = transformed(p, units, units.diagonal().cwiseInverse().asDiagonal(), measured_units);
  const outcome elsewhere = after(f, rescaled.prior, rescaled.a, rescaled.b);
  CHECK(elsewhere.posterior.mean == units * posterior.posterior.mean);
  CHECK(elsewhere.posterior.covariance == units * posterior.posterior.covariance * units);
  CHECK(elsewhere.chi2 == posterior.chi2);
}

/// Each of 1 to 9 components, each of 1 to 4 measured numbers.
template <class Policy>
void check_shapes(const Policy& policy, unsigned seed) {
  std::mt19937_64 engine(seed);
  for (int trial = 0; trial < 5; ++trial) {
    check_update(updating<1, 1>(policy), 1, 1, engine);
    check_update(updating<2, 2>(policy), 2, 2, engine);
    check_update(updating<3, 3>(policy), 3, 3, engine);
    check_update(updating<4, 4>(policy), 4, 4, engine);
    check_update(updating<5, 2>(policy), 5, 2, engine);
    check_update(updating<6, 1>(policy), 6, 1, engine);
    check_update(updating<7, 3>(policy), 7, 3, engine);
    check_update(updating<8, 1>(policy), 8, 1, engine);
    check_update(updating<9, 4>(policy), 9, 4, engine);
  }
}

}  // namespace

TEST_CASE("the plain form is least squares, in any order, frame and units", "[kalman]") { check_shapes(kalman::plain{}, 31); }

TEST_CASE("Joseph's form is least squares, in any order, frame and units", "[kalman]") { check_shapes(kalman::joseph{}, 32); }

TEST_CASE("the symmetric form is least squares, in any order, frame and units", "[kalman]") { check_shapes(kalman::symmetric_form{}, 33); }

TEST_CASE("the square-root form is least squares, in any order, frame and units", "[kalman]") { check_shapes(kalman::square_root{}, 34); }

TEST_CASE("the iterated form of a linear measurement is least squares, in any order, frame and units", "[kalman]") { check_shapes(kalman::iterated{}, 35); }

TEST_CASE("an update in packs is least squares in its lane, in any order, frame and units", "[kalman]") { check_shapes(in_packs{}, 36); }
