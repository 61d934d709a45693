// SPDX-License-Identifier: MPL-2.0
#include <cmath>
#include <random>
#include <vector>

#include "support/catch.hpp"

#include <scifi/study/sample.hpp>

using namespace scifi::study;

TEST_CASE("quantiles lie linearly between order statistics", "[study]") {
  const std::vector<double> sorted{1.0, 2.0, 4.0, 8.0, 16.0};
  CHECK(quantile(sorted, 0.0) == 1.0);
  CHECK(quantile(sorted, 0.5) == 4.0);
  CHECK(quantile(sorted, 0.625) == 6.0);
  CHECK(quantile(sorted, 1.0) == 16.0);
  CHECK(std::isnan(quantile({}, 0.5)));
}

TEST_CASE("the summary of nothing and of one value", "[study]") {
  CHECK(summarise({}).count == 0);
  CHECK(std::isnan(summarise({}).spread));
  sample one;
  one.add(3.0);
  CHECK(summarise(one).median == 3.0);
  CHECK(summarise(one).mean == 3.0);
  CHECK(summarise(one).spread == 0.0);
}

TEST_CASE("a summary does not depend on the order nor on what was merged", "[study]") {
  sample all, reversed, first, second;
  for (int i = 0; i < 1001; ++i) {
    const double x = std::sin(1.3 * i) * i;
    all.add(x);
    (i % 3 == 0 ? first : second).add(x);
  }
  for (std::size_t i = all.size(); i-- > 0;) reversed.add(all.values()[i]);
  second += first;
  for (const sample* other : {&reversed, &second}) {
    CHECK(summarise(*other).mean == summarise(all).mean);
    CHECK(summarise(*other).median == summarise(all).median);
    CHECK(summarise(*other).spread == summarise(all).spread);
  }
  first += first;
  CHECK(first.size() == 668);
}

TEST_CASE("the errors of median and spread are what many normal samples scatter by", "[study]") {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal(2.0, 3.0);
  constexpr int samples = 600;
  constexpr int size = 400;
  sample medians, spreads;
  double median_error = 0.0, spread_error = 0.0;
  for (int i = 0; i < samples; ++i) {
    sample s;
    for (int j = 0; j < size; ++j) s.add(normal(random));
    const summary of = summarise(s);
    medians.add(of.median);
    spreads.add(of.spread);
    median_error += of.median_error / samples;
    spread_error += of.spread_error / samples;
  }
  // A width from n samples is known to 1/sqrt(2n) = 2.9 %; that of the central 68 % to 0.96/sqrt(n) = 3.9 %. Three of those.
  CHECK(summarise(medians).mean == Approx(2.0).margin(3.0 * median_error / std::sqrt(samples)));
  CHECK(summarise(spreads).mean == Approx(3.0).epsilon(0.01));
  CHECK(summarise(medians).spread == Approx(median_error).epsilon(0.12));
  CHECK(summarise(spreads).spread == Approx(spread_error).epsilon(0.12));
}

TEST_CASE("the tail is the share beyond five spreads of zero, not of the median", "[study]") {
  sample s;
  for (int i = -50; i <= 50; ++i) s.add(i / 50.0);  // uniform: spread 0.683
  s.add(3.9);
  s.add(-4.1);
  s.add(3.0);
  CHECK(summarise(s).tail == Approx(2.0 / 104.0));
}
