// SPDX-License-Identifier: MPL-2.0
#include <scifi/core/trigonometry.hpp>

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include <cmath>
#include <limits>

#include "support/catch.hpp"

using scifi::turning;
using scifi::turning_at;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// The same functions in extended precision: the power series to convergence up to |t| = 2, the closed form above.
turning<long double> reference(long double t) {
  turning<long double> r{std::sin(t), std::cos(t), 0.0L, 0.0L, 0.0L, 0.0L};
  if (std::abs(t) > 2.0L) {
    r.s1 = r.sine / t;
    r.c1 = (1.0L - r.cosine) / t;
    r.d_s1 = (t * r.cosine - r.sine) / (t * t);
    r.d_c1 = (t * r.sine + r.cosine - 1.0L) / (t * t);
    return r;
  }
  // t^n/(n+1)! with alternating signs: s1 takes the even n, c1 the odd ones.
  long double power_over_factorial = 1.0L;
  for (int n = 0; n < 40; ++n) {
    const long double sign = n / 2 % 2 == 0 ? 1.0L : -1.0L;
    const long double derivative = n == 0 ? 0.0L : sign * n * std::pow(t, n - 1) / std::tgamma(static_cast<long double>(n + 2));
    (n % 2 == 0 ? r.s1 : r.c1) += sign * power_over_factorial;
    (n % 2 == 0 ? r.d_s1 : r.d_c1) += derivative;
    power_over_factorial *= t / static_cast<long double>(n + 2);
  }
  return r;
}

double off(double value, long double expected) { return static_cast<double>(std::abs(static_cast<long double>(value) - expected)); }

}  // namespace

TEST_CASE("the functions of a turning angle agree with extended precision on both sides of the switch", "[core]") {
  for (const double t : {0.0, 1e-300, 1e-12, 1e-8, 1e-4, 0.01, 0.1, 0.3, 0.49, 0.499999, 0.5, 0.500001, 0.51, 0.7, 1.0, 1.9, 2.1, 3.14159, 6.0, 20.0}) {
    for (const double signed_t : {t, -t}) {
      INFO("t " << signed_t);
      const turning<double> f = turning_at(signed_t);
      const turning<long double> r = reference(signed_t);
      // sin and cos round by 1 ulp; a quotient by |t| >= 0.5 doubles the absolute error, a second one doubles it again (a factor 4).
      CHECK(off(f.sine, r.sine) <= eps);
      CHECK(off(f.cosine, r.cosine) <= eps);
      CHECK(off(f.s1, r.s1) <= 4.0 * eps);
      CHECK(off(f.c1, r.c1) <= 4.0 * eps);
      CHECK(off(f.d_s1, r.d_s1) <= 8.0 * eps);
      CHECK(off(f.d_c1, r.d_c1) <= 8.0 * eps);
    }
  }
}

TEST_CASE("for small angles the odd functions keep their relative precision", "[core]") {
  for (const double t : {1e-200, 1e-9, 1e-3, 0.4, 0.4999}) {
    const turning<double> f = turning_at(t);
    const turning<long double> r = reference(t);
    CHECK(off(f.c1, r.c1) <= 4.0 * eps * std::abs(f.c1));
    CHECK(off(f.d_s1, r.d_s1) <= 4.0 * eps * std::abs(f.d_s1));
  }
}

TEST_CASE("series and closed form join at half a radian", "[core]") {
  const double below = std::nextafter(0.5, 0.0);
  const turning<double> a = turning_at(below), b = turning_at(0.5);
  CHECK(std::abs(a.s1 - b.s1) <= 4.0 * eps);
  CHECK(std::abs(a.c1 - b.c1) <= 4.0 * eps);
  CHECK(std::abs(a.d_s1 - b.d_s1) <= 8.0 * eps);
  CHECK(std::abs(a.d_c1 - b.d_c1) <= 8.0 * eps);
}

TEST_CASE("the derivatives are those that dual numbers find", "[core]") {
  using dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, 1, 1>>;
  for (const double t : {-3.0, -0.6, -0.3, 0.0, 1e-5, 0.2, 0.499, 0.501, 1.5, 7.0}) {
    INFO("t " << t);
    const turning<dual> d = turning_at(dual(t, 1, 0));
    const turning<double> f = turning_at(t);
    CHECK(std::abs(d.s1.derivatives()(0) - f.d_s1) <= 8.0 * eps);
    CHECK(std::abs(d.c1.derivatives()(0) - f.d_c1) <= 8.0 * eps);
    CHECK(std::abs(d.sine.derivatives()(0) - f.cosine) <= 4.0 * eps);
    CHECK(std::abs(d.cosine.derivatives()(0) + f.sine) <= 4.0 * eps);
  }
}

TEST_CASE("in single precision the errors are those of its rounding", "[core]") {
  constexpr double single = std::numeric_limits<float>::epsilon();
  for (const float t : {0.0f, 1e-6f, 0.1f, 0.49f, 0.5f, 0.51f, 1.0f, -2.0f, 5.0f}) {
    INFO("t " << t);
    const turning<float> f = turning_at(t);
    const turning<long double> r = reference(static_cast<long double>(t));
    CHECK(off(static_cast<double>(f.s1), r.s1) <= 4.0 * single);
    CHECK(off(static_cast<double>(f.c1), r.c1) <= 4.0 * single);
    CHECK(off(static_cast<double>(f.d_s1), r.d_s1) <= 8.0 * single);
    CHECK(off(static_cast<double>(f.d_c1), r.d_c1) <= 8.0 * single);
  }
}

TEST_CASE("an angle that is not a number gives numbers that are none", "[core]") {
  const turning<double> f = turning_at(std::nan(""));
  CHECK(std::isnan(f.s1));
  CHECK(std::isnan(f.d_c1));
}
