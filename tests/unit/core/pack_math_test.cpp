// SPDX-License-Identifier: MPL-2.0
#include <scifi/core/pack_math.hpp>

#include <cmath>
#include <limits>
#include <random>

#include "support/catch.hpp"

using namespace scifi;

namespace {

/// Largest deviation of f from the library's function in extended precision, in units of the rounding error of T: of the value, or of `scale` where that is larger.
template <class T, class F, class Exact>
double worst(double from, double to, double scale, const F& f, const Exact& exact) {
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> flat(from, to);
  double out = 0.0;
  for (int i = 0; i < 4000; ++i) {
    pack<T> x;
    for (int lane = 0; lane < pack<T>::lanes; ++lane) x.set(lane, static_cast<T>(flat(engine)));
    const pack<T> y = f(x);
    for (int lane = 0; lane < pack<T>::lanes; ++lane) {
      const long double want = exact(static_cast<long double>(x[lane]));
      const long double unit = std::max(std::fabs(want), static_cast<long double>(scale)) * static_cast<long double>(std::numeric_limits<T>::epsilon());
      out = std::max(out, static_cast<double>(std::fabs(static_cast<long double>(y[lane]) - want) / unit));
    }
  }
  return out;
}

template <class T>
void check_accuracy(double exponents, double angles) {
  const auto log_ = [](const auto& x) { return log(x); };
  const auto exp_ = [](const auto& x) { return exp(x); };
  const auto exact_log = [](long double x) { return std::log(x); };
  const auto exact_exp = [](long double x) { return std::exp(x); };
  CHECK(worst<T>(1e-30, 1e-3, 0.0, log_, exact_log) < 1.5);
  CHECK(worst<T>(0.5, 2.0, 0.0, log_, exact_log) < 1.5);
  CHECK(worst<T>(2.0, 1e30, 0.0, log_, exact_log) < 1.5);
  CHECK(worst<T>(-exponents, exponents, 0.0, exp_, exact_exp) < 1.5);
  CHECK(worst<T>(-1e-3, 1e-3, 0.0, exp_, exact_exp) < 1.5);
  CHECK(worst<T>(-angles, angles, 1.0, [](const auto& x) { return sin(x); }, [](long double x) { return std::sin(x); }) < 1.5);
  CHECK(worst<T>(-angles, angles, 1.0, [](const auto& x) { return cos(x); }, [](long double x) { return std::cos(x); }) < 1.5);
  CHECK(worst<T>(-angles, angles, 1.0, [](const auto& x) { return sincos_of(x).cosine; }, [](long double x) { return std::cos(x); }) < 1.5);
  CHECK(worst<T>(-0.1, 0.1, 0.0, [](const auto& x) { return sin(x); }, [](long double x) { return std::sin(x); }) < 1.5);
}

}  // namespace

TEST_CASE("logarithm, exponential, sine and cosine of packs are right to the last place", "[core]") {
  check_accuracy<double>(700.0, 1e5);
  check_accuracy<float>(85.0, 1e3);
}

TEST_CASE("functions of packs at the ends of their ranges", "[core]") {
  using p = pack<double>;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::nan("");
  CHECK(log(p(1.0))[0] == 0.0);
  CHECK(log(p(0.0))[0] == -infinity);
  CHECK(log(p(infinity))[0] == infinity);
  CHECK(std::isnan(log(p(-1.0))[0]));
  CHECK(std::isnan(log(p(nan))[0]));
  CHECK(exp(p(0.0))[0] == 1.0);
  CHECK(exp(p(-infinity))[0] == 0.0);
  CHECK(exp(p(1000.0))[0] == infinity);
  CHECK(std::isnan(exp(p(nan))[0]));
  CHECK(sin(p(0.0))[0] == 0.0);
  CHECK(cos(p(0.0))[0] == 1.0);
  CHECK(std::isnan(sin(p(nan))[0]));
  CHECK(std::isnan(cos(p(infinity))[0]));
}
