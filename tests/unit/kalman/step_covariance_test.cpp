// SPDX-License-Identifier: MPL-2.0
#include <scifi/kalman/step_covariance.hpp>

#include <random>

#include <scifi/core/pack.hpp>

#include "support/catch.hpp"

using scifi::matrix;

namespace {

/// f p f' + q with the declared columns of f as in the identity, against Eigen's product in double.
template <class Scalar, unsigned Unit, int N>
void check(double tolerance) {
  std::mt19937_64 engine(N);
  std::normal_distribution<double> normal;
  matrix<double, N, N> f, a, b;
  for (int i = 0; i < N * N; ++i) {
    f.data()[i] = normal(engine);
    a.data()[i] = normal(engine);
    b.data()[i] = normal(engine);
  }
  for (int j = 0; j < N; ++j)
    if (scifi::kalman::detail::has_bit(Unit, j)) f.col(j) = matrix<double, N, N>::Identity().col(j);
  const matrix<double, N, N> p = a * a.transpose(), q = b * b.transpose();
  const matrix<double, N, N> expected = f * p * f.transpose() + q;
  const auto cast = [](const matrix<double, N, N>& m) {
    matrix<Scalar, N, N> out;
    for (int i = 0; i < N * N; ++i) out.data()[i] = Scalar(m.data()[i]);
    return out;
  };
  matrix<Scalar, N, N> found;
  scifi::kalman::detail::carry_covariance<Unit, Scalar, N>(found, cast(f), cast(p), cast(q));
  const auto number = [](const Scalar& x) {
    if constexpr (requires { x[0]; }) return static_cast<double>(x[Scalar::lanes - 1]);
    else return static_cast<double>(x);
  };
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) {
      CHECK(std::abs(number(found(i, j)) - expected(i, j)) < tolerance * expected.norm());
      CHECK(number(found(i, j)) == number(found(j, i)));
    }
  }
}

}  // namespace

TEST_CASE("a covariance is carried over a step whatever of its Jacobian is declared", "[kalman]") {
  check<double, 0b00000u, 5>(1e-14);
  check<double, 0b00101u, 5>(1e-14);
  check<double, 0b11111u, 5>(1e-14);
  check<double, 0b0101u, 4>(1e-14);
  check<double, 0b000111u, 6>(1e-14);
  check<double, 0b1u, 1>(1e-14);
  check<float, 0b00101u, 5>(1e-5);
  check<long double, 0b00101u, 5>(1e-14);
  check<scifi::pack<double>, 0b00101u, 5>(1e-14);
}
