// SPDX-License-Identifier: MPL-2.0
#include <cmath>
#include <random>

#include "support/catch.hpp"

#include <scifi/study/flatness.hpp>

using namespace scifi::study;

// N. Smirnov, Ann. Math. Stat. 19 (1948) 279: table of the limiting distribution, as one minus it, and its usual critical values.
TEST_CASE("Kolmogorov's distribution is the tabulated one on both sides of the change of series", "[study]") {
  CHECK(kolmogorov_survival(0.50) == Approx(1.0 - 0.036055).margin(1e-6));
  CHECK(kolmogorov_survival(0.82757) == Approx(0.5).margin(2e-5));  // the median
  CHECK(kolmogorov_survival(1.00) == Approx(1.0 - 0.730000).margin(1e-6));
  CHECK(kolmogorov_survival(1.2238) == Approx(0.10).margin(5e-5));
  CHECK(kolmogorov_survival(1.3581) == Approx(0.05).margin(2e-5));
  CHECK(kolmogorov_survival(1.6276) == Approx(0.01).margin(2e-5));
  CHECK(kolmogorov_survival(0.0) == 1.0);
  CHECK(kolmogorov_survival(1.18 - 1e-9) == Approx(kolmogorov_survival(1.18 + 1e-9)).epsilon(1e-6));
}

TEST_CASE("the distance is the largest gap to the diagonal, on either side of a step", "[study]") {
  sample one;
  one.add(0.3);
  CHECK(flatness_of(one).distance == Approx(0.7));
  sample even;
  for (int i = 0; i < 10; ++i) even.add((i + 0.5) / 10);
  CHECK(flatness_of(even).distance == Approx(0.05));
  CHECK(flatness_of(even).probability > 0.999);
  sample low;
  for (int i = 0; i < 10; ++i) low.add((i + 0.5) / 20);
  CHECK(flatness_of(low).distance == Approx(0.525));
  CHECK(std::isnan(flatness_of({}).distance));
}

TEST_CASE("uniform numbers have a uniform probability, squares of them almost none", "[study]") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform;
  sample probabilities;
  for (int i = 0; i < 400; ++i) {
    sample s;
    for (int j = 0; j < 100; ++j) s.add(uniform(random));
    probabilities.add(flatness_of(s).probability);
  }
  // D of n values exceeds 1.63/sqrt(n) once in a hundred samples.
  CHECK(flatness_of(probabilities).distance < 1.63 / std::sqrt(400.0));
  sample squares;
  for (int j = 0; j < 300; ++j) squares.add(std::pow(uniform(random), 2.0));
  CHECK(flatness_of(squares).probability < 1e-6);
  CHECK(flatness_of(squares).distance == Approx(0.25).margin(1.63 / std::sqrt(300.0)));  // max of sqrt(p) - p
}
