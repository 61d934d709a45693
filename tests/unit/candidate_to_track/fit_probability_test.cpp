// SPDX-License-Identifier: MPL-2.0
#include <scifi/candidate_to_track/fit_probability.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <scifi/core/random.hpp>

#include "support/catch.hpp"

using namespace scifi;

TEST_CASE("Gaussian errors give the chi-squared probability", "[candidate_to_track]") {
  CHECK(gaussian_probability{}({18.307, 10, 3.0, 5, 6.0, 3}) == Approx(0.05).epsilon(1e-3));  // Abramowitz and Stegun, table 26.8
}

TEST_CASE("with a Gaussian law the closures are left out and nothing else changes", "[candidate_to_track]") {
  const fibre_probability gaussian{{{1.0, 0.0, 0.0}, {1.0, 1.0, 1.0}}, 1.0};
  // 11.070 is exceeded by chi-squared with 5 degrees of freedom in 5 % (the same table).
  CHECK(gaussian({14.070, 10, 3.0, 5, 6.5, 3}) == Approx(0.05).epsilon(1e-3));
  CHECK(gaussian({11.070, 5, 0.0, 0, 2.0, 2}) == Approx(0.05).epsilon(1e-3));
  CHECK(gaussian({2.0, 10, 3.0, 5, 6.5, 3}) == 1.0);  // rounding can make the rest negative
}

TEST_CASE("nothing beyond the closures: the chi-squared probability", "[candidate_to_track]") {
  CHECK(fibre_probability{}({9.488, 4, 4.0, 4, 4.0, 1}) == Approx(0.05).epsilon(1e-3));
  CHECK(std::isnan(fibre_probability{}({0.0, 0, 0.0, 0, 0.0, 0})));
}

TEST_CASE("triplets close, doublets have nothing to close", "[candidate_to_track]") {
  std::vector<space_point> points(3);
  points[0].chi2 = 1.5;
  points[0].clusters = {0, 1, 2};
  points[1].clusters = {3, 4};
  points[2].chi2 = 0.25;
  points[2].clusters = {5, 6, 7};
  candidate c;
  c.space_points = {0, 1, 2};
  const fit_summary f = closures_of(c, points);
  CHECK(f.closures == 2);
  CHECK(f.closure == 1.75);
}

TEST_CASE("a p-value of sums drawn from the law it states is flat", "[candidate_to_track]") {
  // Six residuals of unit variance, two to a station, 28 % of it measurement and the rest the angle scattered there, whose variance is drawn from the law.
  const fibre_probability probability{{}, 1.0};
  constexpr std::size_t number = 20000;
  std::vector<double> p;
  random_stream random(3, 0, 0);
  for (std::size_t i = 0; i < number; ++i) {
    double chi2 = 0.0;
    for (int s = 0; s < 3; ++s) {
      const double u = random.uniform();
      const auto& t = probability.tail;
      const double v = t.variance[u < t.share[0] ? 0 : u < t.share[0] + t.share[1] ? 1 : 2];
      chi2 += (0.28 + 0.72 * v) * (std::pow(random.normal(), 2) + std::pow(random.normal(), 2));
    }
    p.push_back(probability({chi2 + 5.0, 11, 5.0, 5, 5.0 + 6.0 * 0.28, 3}));
  }
  std::sort(p.begin(), p.end());
  double distance = 0.0;
  for (std::size_t i = 0; i < number; ++i) distance = std::max(distance, std::abs(p[i] - (static_cast<double>(i) + 0.5) / number));
  // Kolmogorov's 0.1 % point 1.95/sqrt(n) = 0.014, and as much again for the gamma distribution in place of the sum.
  CHECK(distance < 0.028);
}
