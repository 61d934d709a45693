// SPDX-License-Identifier: MPL-2.0
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <scifi/core/chi_squared.hpp>
#include <scifi/core/gamma_probability.hpp>
#include <scifi/core/pack_math.hpp>
#include <scifi/core/random.hpp>
#include <scifi/core/trigonometry.hpp>

#include "extreme/extremes.hpp"
#include "support/catch.hpp"

using namespace scifi;
using test::extremes;
using test::infinity;

namespace {

/// Chi-squared of many degrees of freedom: its cube root is normal (Wilson and Hilferty 1931), to 1e-5 from a thousand on.
double by_cube_root(double chi2, double ndf) {
  const double width = 2.0 / (9.0 * ndf);
  return 0.5 * std::erfc((std::cbrt(chi2 / ndf) - (1.0 - width)) / std::sqrt(2.0 * width));
}

}  // namespace

TEST_CASE("a chi-squared probability is one for every number that is not negative, and NaN for every other", "[extreme]") {
  for (const double chi2 : extremes)
    for (const int ndf : {std::numeric_limits<int>::min(), -1, 0, 1, 2, 15, 1000, 100001}) {
      INFO(chi2 << " with " << ndf);
      const double q = chi_squared_probability(chi2, ndf);
      if (chi2 >= 0.0 && ndf >= 1) CHECK((q >= 0.0 && q <= 1.0));
      else CHECK(std::isnan(q));
    }
}

TEST_CASE("a chi-squared beyond the range of the exponential function has its probability", "[extreme]") {
  for (const int ndf : {1400, 2000, 2001, 100000, 1000001})
    for (const double sigmas : {-5.0, -1.0, 0.0, 1.0, 3.0}) {
      const double chi2 = ndf + sigmas * std::sqrt(2.0 * ndf);
      INFO(chi2 << " with " << ndf);
      CHECK(chi_squared_probability(chi2, ndf) == Approx(by_cube_root(chi2, ndf)).margin(3e-5));
    }
  CHECK(chi_squared_probability(5000.0, 2) == 0.0);
  CHECK(chi_squared_probability(1300.0, 2) == Approx(std::exp(-650.0)).epsilon(1e-12));
  CHECK(chi_squared_probability(1480.0, 2) == Approx(std::exp(-740.0)).epsilon(1e-2));  // less than the smallest normal number
}

TEST_CASE("a gamma probability is one for every shape above zero, and NaN for every other", "[extreme]") {
  for (const double shape : extremes)
    for (const double x : extremes) {
      INFO(shape << " at " << x);
      const double q = gamma_probability(shape, x);
      if (shape > 0.0 && x >= 0.0) CHECK((q >= 0.0 && q <= 1.0));
      else CHECK(std::isnan(q));
    }
}

TEST_CASE("gamma probabilities of large shapes are those of chi-squared with twice as many degrees of freedom", "[extreme]") {
  for (const int half : {149, 150, 151, 700, 9999, 10000, 10001, 400000})
    for (const double sigmas : {-4.0, -1.0, 0.0, 0.5, 4.0, 8.0}) {
      const double x = half + sigmas * std::sqrt(half);
      INFO(x << " of shape " << half);
      const double expected = chi_squared_probability(2.0 * x, 2 * half);
      CHECK(gamma_probability(half, x) == Approx(expected).epsilon(half > 10000 ? 0.0 : 1e-9).margin(half > 10000 ? 1e-6 : 1e-13));
    }
}

TEST_CASE("Poisson numbers of any mean come in a moment and are of that mean", "[extreme]") {
  constexpr int most = std::numeric_limits<int>::max();
  random_stream random(1, 2, 3);
  for (const double mean : extremes) {
    INFO(mean);
    const int n = random.poisson(mean);
    CHECK(n == (mean >= 1e16 ? most : 0));
  }
  // Either side of where the sampling changes; the errors of mean and variance follow from the number of draws.
  for (const double mean : {999999.0, 1000001.0, 2.0e8}) {
    constexpr int draws = 400;
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < draws; ++i) {
      const double off = (random.poisson(mean) - mean) / std::sqrt(mean);
      sum += off / draws;
      squares += off * off / draws;
    }
    INFO(mean);
    CHECK(std::abs(sum) < 4.0 / std::sqrt(draws));
    CHECK(std::abs(squares - 1.0) < 4.0 * std::sqrt(2.0 / draws));
  }
  for (const double mean : {1e-320, 1e-300, 1e-17, 1e-3, 1.0, 99.0, 101.0, 800.0, 1e7, 1e300, infinity}) {
    INFO(mean);
    const int n = random.poisson_above_zero(mean);
    CHECK(n >= 1);
    if (mean < 1e-3) CHECK(n == 1);
    if (mean >= 99.0 && mean < 1e8) CHECK(std::abs(n - mean) < 6.0 * std::sqrt(mean));
  }
}

TEST_CASE("a turning angle of any size has a sine and a cosine, and one that is not finite has none", "[extreme]") {
  for (const double t : extremes) {
    INFO(t);
    const turning<double> at = turning_at(t);
    if (std::isfinite(t)) {
      CHECK(at.sine * at.sine + at.cosine * at.cosine == Approx(1.0).epsilon(1e-14));
      CHECK(at.s1 * t == Approx(at.sine).epsilon(1e-12).margin(0.0));
      CHECK(at.c1 * t == Approx(2.0 * std::sin(0.5 * t) * std::sin(0.5 * t)).epsilon(1e-12).margin(1e-15));
      CHECK((std::isfinite(at.d_s1) && std::isfinite(at.d_c1)));
    } else {
      CHECK((std::isnan(at.sine) && std::isnan(at.cosine) && std::isnan(at.s1) && std::isnan(at.c1) && std::isnan(at.d_s1) && std::isnan(at.d_c1)));
    }
  }
}

TEST_CASE("functions of packs give in each lane the right number, or NaN where they have no range", "[extreme]") {
  using lanes = pack<double, 2>;
  for (const double x : extremes) {
    INFO(x);
    lanes both(1.0);
    both.set(1, x);
    CHECK(sin(both)[0] == Approx(std::sin(1.0)).epsilon(1e-15));  // whatever its neighbour is
    if (std::abs(x) <= 1e5) {
      CHECK(sin(both)[1] == Approx(std::sin(x)).margin(1e-15));
      CHECK(cos(both)[1] == Approx(std::cos(x)).margin(1e-15));
    } else {
      CHECK((std::isnan(sin(both)[1]) && std::isnan(cos(both)[1])));
    }
    const double e = exp(both)[1];
    if (std::isnan(x)) CHECK(std::isnan(e));
    else CHECK((e == Approx(std::exp(x)).epsilon(1e-14) || e == std::exp(x)));
    const double l = log(both)[1];
    if (std::isnan(x) || x < 0.0) CHECK(std::isnan(l));
    else if (x < std::numeric_limits<double>::min()) CHECK(l == -infinity);
    else CHECK((l == Approx(std::log(x)).epsilon(1e-14) || l == x));
  }
}
