// SPDX-License-Identifier: MPL-2.0
#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Dense>

#include "support/catch.hpp"

#include <scifi/study/flatness.hpp>

using namespace scifi::study;

namespace {

/// P(chi2 of 10 degrees of freedom > c): of a Poisson number of mean c/2 below five.
double survival_of_ten(double c) {
  double sum = 0.0, term = std::exp(-0.5 * c);
  for (int k = 0; k < 5; term *= 0.5 * c / ++k) sum += term;
  return sum;
}

/// Least squares of position, slope and bend through 15 planes of a tracker, in channels that say only that they were hit or that have Gaussian errors of the same variance;
/// `kick` is the standard deviation of the scattering angle in a station. Everything is linear and known exactly.
flatness of_ideal_fits(double kick, bool channels, std::mt19937_64& random) {
  constexpr int planes = 15, tracks = 8000;
  constexpr double width = 1.4945, variance = width * width / 12.0;
  constexpr double station_z[] = {0.0, 200.0, 450.0, 750.0, 1100.0};
  Eigen::MatrixXd design(planes, 5), scattering = Eigen::MatrixXd::Zero(planes, planes);
  Eigen::VectorXd across(planes), along(planes);
  for (int i = 0; i < planes; ++i) {
    const double c = std::cos(2.0943951 * (i % 3)), s = std::sin(2.0943951 * (i % 3)), z = station_z[i / 3];
    design.row(i) << c, s, z * c, z * s, 1e-3 * z * z * (c - s);
    across[i] = c;
    along[i] = s;
  }
  for (const double at : station_z)
    for (int i = 0; i < planes; ++i)
      for (int j = 0; j < planes; ++j)
        scattering(i, j) += kick * kick * std::max(station_z[i / 3] - at, 0.0) * std::max(station_z[j / 3] - at, 0.0) * (across[i] * across[j] + along[i] * along[j]);
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(planes, planes);
  const Eigen::MatrixXd weight = (scattering + variance * identity).inverse();
  const Eigen::MatrixXd wd = weight * design;
  const Eigen::MatrixXd of_residuals = weight - wd * (design.transpose() * wd).inverse() * wd.transpose();
  const Eigen::MatrixXd kicks = (scattering + 1e-12 * identity).llt().matrixL();
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> within(-0.5 * width, 0.5 * width);
  sample probabilities;
  Eigen::VectorXd e(planes);
  for (int t = 0; t < tracks; ++t) {
    for (int i = 0; i < planes; ++i) e[i] = normal(random);
    e = kicks * e;
    for (int i = 0; i < planes; ++i) e[i] += channels ? within(random) : std::sqrt(variance) * normal(random);
    probabilities.add(survival_of_ten(e.dot(of_residuals * e)));
  }
  return flatness_of(probabilities);
}

}  // namespace

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

TEST_CASE("p-values of a perfect fit are flat for Gaussian errors, and not nearer than 0.025 to it where channels say only that they were hit", "[study]") {
  std::mt19937_64 random(7);
  for (const double kick : {0.002, 0.004, 0.006}) {
    INFO("kick " << kick);
    CHECK(of_ideal_fits(kick, false, random).distance < 1.63 / std::sqrt(8000.0));
    CHECK(of_ideal_fits(kick, true, random).distance > 0.025);
  }
}
