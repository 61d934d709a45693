// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <scifi/material/bethe.hpp>
#include <scifi/material/landau.hpp>
#include <scifi/material/materials.hpp>

#include "dual.hpp"

using namespace scifi;

namespace {

constexpr double pi = 3.14159265358979323846;

// Landau's density and distribution, J. Phys. USSR 8 (1944) 201, in the form of Kolbig and Schorr, Comput. Phys. Commun. 31 (1984) 97:
// phi(l) = 1/pi int_0^inf exp(-t ln t - l t) sin(pi t) dt; its integral has 1/t more. Simpson's rule; the integrand is negligible above 30.
template <class Weight>
double landau_integral(double lambda, Weight weight) {
  const int n = 20000;
  const double top = 30.0, step = top / n;
  double sum = 0.0;
  for (int i = 1; i <= n; ++i) {
    const double t = i * step;
    sum += (i == n ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0)) * std::exp(-t * std::log(t) - lambda * t) * std::sin(pi * t) * weight(t);
  }
  return (sum + weight(0.0)) * step / 3.0 / pi;
}
double landau_density(double lambda) {
  return landau_integral(lambda, [](double t) { return t > 0.0 ? 1.0 : 0.0; });
}
double landau_distribution(double lambda) {
  return 1.0 - landau_integral(lambda, [](double t) { return t > 0.0 ? 1.0 / t : pi; });
}

double crossing(double level, double inside, double outside) {
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (inside + outside);
    (landau_density(middle) > level ? inside : outside) = middle;
  }
  return inside;
}

// Energy losses made from single collisions: Rutherford's cross-section with spin 1/2, xi/T^2 (1 - beta^2 T/Tmax), above `cut` one by one,
// below it a Gaussian whose mean makes up Bethe's mean loss. Knows nothing of Landau's result. Returned sorted, in units of xi.
std::vector<double> simulated_losses(double p, const particle& h, const material& m, double path, int events, unsigned seed) {
  const auto k = ionisation_kinematics_of(p, h);
  const double xi = landau_xi(k, h, m, path), top = k.largest_transfer, cut = 0.02 * xi, beta2 = k.beta_squared;
  const double hard_mean = xi * (std::log(top / cut) - beta2 * (1.0 - cut / top));
  const double soft_mean = mean_energy_loss_rate(p, h, m).value * path - hard_mean;
  std::mt19937_64 random(seed);
  std::poisson_distribution<int> collisions(xi * (1.0 / cut - 1.0 / top));
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> soft(soft_mean, std::sqrt(xi * cut));
  std::vector<double> losses(static_cast<std::size_t>(events));
  for (double& loss : losses) {
    loss = soft(random);
    for (int n = collisions(random); n > 0; --n) {
      const double transfer = 1.0 / (1.0 / cut - uniform(random) * (1.0 / cut - 1.0 / top));
      if (uniform(random) > beta2 * transfer / top) loss += transfer;
    }
    loss /= xi;
  }
  std::sort(losses.begin(), losses.end());
  return losses;
}

}  // namespace

TEST_CASE("The numbers of the Landau density are those of its integral", "[material]") {
  CHECK(landau_distribution(landau::median) == Approx(0.5).margin(1e-6));
  const double at = landau::mode, step = 1e-3;
  CHECK(landau_density(at) > landau_density(at - step));
  CHECK(landau_density(at) > landau_density(at + step));
  const double half = 0.5 * landau_density(at);
  CHECK(crossing(half, at, 10.0) - crossing(half, at, -4.0) == Approx(landau::full_width).margin(1e-3));
  CHECK(landau::median_above_mode == Approx(1.5784).margin(2e-4));
  CHECK(landau::gaussian_full_width == Approx(2.0 * std::sqrt(2.0 * std::log(2.0))).epsilon(1e-15));
  // j = 1 - Euler's constant + mode (Landau; Bichsel rounds to 0.200).
  CHECK(landau::most_probable_offset == Approx(1.0 - 0.57721566490153286 + landau::mode).margin(5e-5));
}

TEST_CASE("xi is the published 0.1535 MeV Z/A per g/cm2 over beta squared", "[material]") {
  // Leo, Techniques (1994) eq. 2.90: xi = 0.1535 z^2 Z/A rho x / beta^2 MeV.
  const auto k = ionisation_kinematics_of(1e5, muon_plus);
  CHECK(landau_xi(k, muon_plus, materials::aluminium, 10.0) == Approx(0.1535 * 0.48181 * 2.699).epsilon(5e-4));
}

TEST_CASE("The most probable loss of 10 GeV muons in 1.7 mm of silicon is the PDG's", "[material]") {
  // PDG 2018 fig. 33.7, read to 1 %: most probable loss 0.525 MeV, full width 4 xi = 0.13 MeV (which leaves out the atomic width).
  constexpr material silicon{"silicon", 2.329, 93.7, 0.49848, 173e-6, {0.14921, 3.2546, 0.2015, 2.8716, 4.4355, 0.14}};
  const auto k = ionisation_kinematics_of(10e3, muon_plus);
  const double xi = landau_xi(k, muon_plus, silicon, 1.7);
  CHECK(xi * most_probable_loss_over_xi(k, silicon, xi).value == Approx(0.525).epsilon(0.01));
  CHECK(landau::full_width * xi == Approx(0.13).epsilon(0.1));
}

TEST_CASE("Mode and median are those of a simulation of single collisions", "[material]") {
  const double p = 400.0, path = 2.0;
  const material m = materials::mylar;
  const auto k = ionisation_kinematics_of(p, muon_plus);
  const double xi = landau_xi(k, muon_plus, m, path);
  REQUIRE(vavilov_kappa(xi, k) < 0.005);
  const int events = 40000;
  const std::vector<double> losses = simulated_losses(p, muon_plus, m, path, events, 7u);
  const double mode = most_probable_loss_over_xi(k, m, xi).value;

  // Error of the sample median: 1/(2 f sqrt N), f = landau_density(median) = 0.116; four of them, and 0.01 for kappa > 0 (terms of order
  // kappa ln kappa). The quantiles at the half maxima are checked with the distribution: a fraction, error sqrt(F(1-F)/N).
  const double median = losses[losses.size() / 2];
  const double f = landau_density(landau::median);
  CHECK(std::abs(median - (mode + landau::median_above_mode)) < 4.0 / (2.0 * f * std::sqrt(events)) + 0.01);
  for (const double lambda : {-1.5, landau::mode, 0.5, 3.0}) {
    const double expected = landau_distribution(lambda);
    const auto below = std::lower_bound(losses.begin(), losses.end(), mode + lambda - landau::mode) - losses.begin();
    const double fraction = static_cast<double>(below) / events;
    CHECK(std::abs(fraction - expected) < 4.0 * std::sqrt(expected * (1.0 - expected) / events) + 0.01 * f);
  }
}

TEST_CASE("Bohr's variance is that of a simulation of single collisions", "[material]") {
  const double p = 120.0, path = 5.0;
  const material m = materials::polystyrene;
  const auto k = ionisation_kinematics_of(p, muon_plus);
  const double xi = landau_xi(k, muon_plus, m, path);
  const int events = 20000;
  const std::vector<double> losses = simulated_losses(p, muon_plus, m, path, events, 11u);
  double sum = 0.0, sum2 = 0.0, sum4 = 0.0;
  for (const double loss : losses) sum += loss;
  const double mean = sum / events;
  for (const double loss : losses) {
    const double square = (loss - mean) * (loss - mean);
    sum2 += square;
    sum4 += square * square;
  }
  const double variance = sum2 / events;
  const double error = std::sqrt((sum4 / events - variance * variance) / events);
  const double expected = bohr_variance(xi, k) / (xi * xi);
  CHECK(std::abs(variance - expected) < 4.0 * error);
  CHECK(4.0 * error < 0.1 * expected);  // the comparison says something
  CHECK(std::abs(mean * xi - mean_energy_loss_rate(p, muon_plus, m).value * path) < 4.0 * xi * std::sqrt(variance / events));
}

TEST_CASE("The Vavilov parameter tells thin from thick", "[material]") {
  // A fibre plane at 200 MeV/c is a Landau absorber, 35 cm of liquid hydrogen is not.
  const auto k = ionisation_kinematics_of(200.0, muon_plus);
  CHECK(vavilov_kappa(landau_xi(k, muon_plus, materials::polystyrene, 0.6273), k) < 0.01);
  CHECK(vavilov_kappa(landau_xi(k, muon_plus, materials::liquid_hydrogen, 350.0), k) > 0.1);
}

TEST_CASE("The derivative of the most probable loss over xi agrees with automatic differentiation", "[material]") {
  for (const material& m : {materials::polystyrene, materials::aluminium, materials::helium}) {
    for (const double p : {40.0, 200.0, 3000.0}) {
      const test::dual x = test::variable(p, 0);
      const auto k = ionisation_kinematics_of(x, muon_plus);
      const auto bracket = most_probable_loss_over_xi(k, m, landau_xi(k, muon_plus, m, test::constant(0.6)));
      CHECK(bracket.d_value_d_beta_gamma.value() / muon_plus.mass == Approx(bracket.value.derivatives()(0)).epsilon(1e-10));
    }
  }
}
