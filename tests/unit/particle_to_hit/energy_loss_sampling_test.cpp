// SPDX-License-Identifier: MPL-2.0
#include <scifi/particle_to_hit/energy_loss_sampling.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/catch.hpp"

using namespace scifi;

namespace {

static_assert(energy_loss_sampler<collision_loss> && energy_loss_sampler<fixed_loss<>>);

std::vector<double> losses(double p, const particle& hypothesis, const material& medium, double path, int pieces, int n, std::uint64_t seed) {
  std::vector<double> out;
  for (int i = 0; i < n; ++i) {
    random_stream random(seed, static_cast<std::uint64_t>(i), 0);
    double sum = 0.0;
    for (int j = 0; j < pieces; ++j) sum += collision_loss{}.sample(p, hypothesis, medium, path / pieces, random);
    out.push_back(sum);
  }
  std::sort(out.begin(), out.end());
  return out;
}

double mean_of(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double v : x) sum += v;
  return sum / static_cast<double>(x.size());
}

double above(const std::vector<double>& sorted, double x) {
  return static_cast<double>(sorted.end() - std::upper_bound(sorted.begin(), sorted.end(), x)) / static_cast<double>(sorted.size());
}

/// Probability that Landau's variable exceeds lambda: (1/pi) int_0^inf exp(-t ln t - lambda t) sin(pi t) / t dt (Landau, J. Phys. USSR 8 (1944) 201).
double landau_above(double lambda) {
  constexpr double h = 2e-3;
  double sum = 0.5 * constants::pi;  // the integrand at t = 0
  for (double t = h; t < 40.0; t += h) sum += std::exp(-t * std::log(t) - lambda * t) * std::sin(constants::pi * t) / t;
  return sum * h / constants::pi;
}

/// Probability that Vavilov's loss exceeds its mean by x largest transfers. The sum of collisions has the characteristic function
/// exp kappa int_0^1 (exp(isu) - 1 - isu) (1 - beta^2 u) / u^2 du (Vavilov, Sov. Phys. JETP 5 (1957) 749), inverted as by Gil-Pelaez, Biometrika 38 (1951) 481.
double vavilov_above(double x, double kappa, double beta_squared) {
  const double end = 30.0 / kappa;  // the real part of the exponent falls as -kappa s pi/2, or faster: exp(-40)
  constexpr int steps = 1000, cells = 1000;
  const double h = end / steps;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double s = (i + 0.5) * h;
    double real = 0.0, imaginary = 0.0;
    for (int j = 0; j < cells; ++j) {
      const double u = (j + 0.5) / cells;
      const double weight = kappa * (1.0 - beta_squared * u) / (u * u * cells);
      real += weight * (std::cos(s * u) - 1.0);
      imaginary += weight * (std::sin(s * u) - s * u);
    }
    sum += std::exp(real) * std::sin(imaginary - s * x) / s;
  }
  return 0.5 + sum * h / constants::pi;
}

}  // namespace

TEST_CASE("the integral used as the oracle gives Landau's published median", "[particle_to_hit]") {
  CHECK(landau_above(landau::median) == Approx(0.5).margin(1e-4));
}

TEST_CASE("collisions lose on average what Bethe's formula says", "[particle_to_hit]") {
  constexpr int n = 40000;
  for (const double path : {0.001, 0.025, 0.3, 5.0}) {
    const auto k = ionisation_kinematics_of(150.0, muon_plus);
    const double expected = mean_energy_loss_rate(150.0, muon_plus, materials::polystyrene).value * path;
    const double variance = bohr_variance(landau_xi(k, muon_plus, materials::polystyrene, path), k);
    CAPTURE(path);
    CHECK(std::abs(mean_of(losses(150.0, muon_plus, materials::polystyrene, path, 1, n, 1)) - expected) < 5.0 * std::sqrt(variance / n));
  }
}

TEST_CASE("thin layers follow Landau's distribution", "[particle_to_hit]") {
  constexpr int n = 60000;
  constexpr double path = 0.62734;
  constexpr double p = 2000.0;  // T_max beyond 20,000 xi: Landau's limit
  const auto k = ionisation_kinematics_of(p, muon_plus);
  const double xi = landau_xi(k, muon_plus, materials::polystyrene, path);
  REQUIRE(vavilov_kappa(xi, k) < 1e-4);
  const double mode = xi * most_probable_loss_over_xi(k, materials::polystyrene, xi).value;
  const std::vector<double> sorted = losses(p, muon_plus, materials::polystyrene, path, 1, n, 2);
  for (const double lambda : {-1.5, -0.5, 0.5, landau::median, 3.0, 6.0, 15.0, 40.0}) {
    const double expected = landau_above(lambda);
    CAPTURE(lambda, expected);
    // Five standard deviations; 2e-3 for the Gaussian sum of small transfers (skewness sqrt(0.1) / 2, smeared by the rest).
    CHECK(std::abs(above(sorted, mode + xi * (lambda - landau::mode)) - expected) < 5.0 * std::sqrt(expected * (1.0 - expected) / n) + 2e-3);
  }
}

TEST_CASE("between, losses follow Vavilov's distribution, whatever kappa", "[particle_to_hit]") {
  constexpr int n = 20000;
  constexpr double p = 200.0;
  const auto k = ionisation_kinematics_of(p, muon_plus);
  const double xi_per_mm = landau_xi(k, muon_plus, materials::polystyrene, 1.0);
  for (const double kappa : {0.05, 0.3, 2.0}) {
    const double path = kappa * k.largest_transfer / xi_per_mm;
    REQUIRE(vavilov_kappa(xi_per_mm * path, k) == Approx(kappa));
    const std::vector<double> sorted = losses(p, muon_plus, materials::polystyrene, path, 1, n, 6);
    const double mean = mean_energy_loss_rate(p, muon_plus, materials::polystyrene).value * path;
    const double width = std::sqrt(kappa * (1.0 - 0.5 * k.beta_squared));  // standard deviation in units of the largest transfer
    for (const double widths : {-1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 3.0}) {
      const double expected = vavilov_above(widths * width, kappa, k.beta_squared);
      CAPTURE(kappa, widths, expected);
      // Five standard deviations; 2e-3 for the Gaussian sum of small transfers, as above.
      CHECK(std::abs(above(sorted, mean + widths * width * k.largest_transfer) - expected) < 5.0 * std::sqrt(expected * (1.0 - expected) / n) + 2e-3);
    }
  }
}

TEST_CASE("thick layers approach a Gaussian of Bohr's variance", "[particle_to_hit]") {
  constexpr int n = 10000;
  const particle heavy{3000.0, 1, 0, "toy"};
  constexpr double p = 1000.0;
  constexpr double path = 4.0;
  const auto k = ionisation_kinematics_of(p, heavy);
  const double xi = landau_xi(k, heavy, materials::polystyrene, path);
  REQUIRE(vavilov_kappa(xi, k) > 2.0);
  const std::vector<double> sorted = losses(p, heavy, materials::polystyrene, path, 1, n, 3);
  const double mean = mean_of(sorted);
  double variance = 0.0;
  for (const double v : sorted) variance += (v - mean) * (v - mean) / n;
  const double expected = xi * k.largest_transfer * (1.0 - 0.5 * k.beta_squared);
  CHECK(std::abs(variance / expected - 1.0) < 5.0 * std::sqrt(2.5 / n));  // excess kurtosis 1 / (3 kappa) at most
}

TEST_CASE("the losses of pieces of a path add up to that of the path", "[particle_to_hit]") {
  constexpr int n = 20000;
  const std::vector<double> one = losses(200.0, muon_plus, materials::polystyrene, 0.6, 1, n, 4);
  const std::vector<double> five = losses(200.0, muon_plus, materials::polystyrene, 0.6, 5, n, 5);
  double distance = 0.0;
  for (std::size_t i = 0; i < one.size(); i += 25) distance = std::max(distance, std::abs(above(five, one[i]) - (1.0 - static_cast<double>(i) / n)));
  // Kolmogorov and Smirnov at a chance of 1e-3: 1.95 sqrt(2 / n); 5e-3 for the two ways of dividing small from large transfers.
  CHECK(distance < 1.95 * std::sqrt(2.0 / n) + 5e-3);
}

TEST_CASE("nothing is lost on no path or in vacuum, and never less than nothing", "[particle_to_hit]") {
  random_stream random(6, 0, 0);
  CHECK(collision_loss{}.sample(200.0, muon_plus, materials::polystyrene, 0.0, random) == 0.0);
  CHECK(collision_loss{}.sample(200.0, muon_plus, materials::vacuum, 10.0, random) == 0.0);
  for (const double path : {1e-6, 1e-4, 1e-2, 1.0})
    for (int i = 0; i < 2000; ++i) REQUIRE(collision_loss{}.sample(120.0, muon_plus, materials::mylar, path, random) >= 0.0);
}

TEST_CASE("a fixed loss is that of its policy", "[particle_to_hit]") {
  random_stream random(7, 0, 0);
  CHECK(fixed_loss<>{}.sample(200.0, muon_plus, materials::polystyrene, 0.5, random) ==
        Approx(0.5 * mean_energy_loss_rate(200.0, muon_plus, materials::polystyrene).value));
  CHECK(fixed_loss<no_energy_loss>{}.sample(200.0, muon_plus, materials::polystyrene, 0.5, random) == 0.0);
}

TEST_CASE("electrons worth following are told and are part of the loss", "[particle_to_hit]") {
  // Number above T_t: xi (1/T_t - 1/T_max - beta^2/T_max ln(T_max/T_t)), the integral of the cross-section.
  constexpr int n = 20000;
  constexpr double threshold = 0.045;
  const double path = 0.63;
  const ionisation_kinematics<double> k = ionisation_kinematics_of(200.0, muon_plus);
  const double xi = landau_xi(k, muon_plus, materials::polystyrene, path);
  const double expected = xi * (1.0 / threshold - 1.0 / k.largest_transfer - k.beta_squared / k.largest_transfer * std::log(k.largest_transfer / threshold));
  int count = 0;
  for (int i = 0; i < n; ++i) {
    random_stream random(21, static_cast<std::uint64_t>(i), 0), same(21, static_cast<std::uint64_t>(i), 0);
    knock_ons electrons{threshold};
    const double loss = collision_loss{}.sample(200.0, muon_plus, materials::polystyrene, path, random, electrons);
    REQUIRE(loss == collision_loss{}.sample(200.0, muon_plus, materials::polystyrene, path, same));
    double carried = 0.0;
    for (const double kinetic_energy : electrons.energies) {
      REQUIRE(kinetic_energy >= threshold);
      REQUIRE(kinetic_energy <= k.largest_transfer * (1.0 + 1e-12));
      carried += kinetic_energy;
      ++count;
    }
    REQUIRE(carried <= loss);
  }
  CHECK(std::abs(count - n * expected) < 5.0 * std::sqrt(n * expected));
}
