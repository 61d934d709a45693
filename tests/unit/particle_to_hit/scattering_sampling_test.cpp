// SPDX-License-Identifier: MPL-2.0
#include <scifi/particle_to_hit/scattering_sampling.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <scifi/core/units.hpp>

#include "support/catch.hpp"

using namespace scifi;

namespace {

static_assert(scattering_sampler<gaussian_scattering<>> && scattering_sampler<coulomb_scattering>);

const slab doublet = whole(materials::polystyrene, 0.62734);

/// All projected angles of n crossings, sorted by magnitude.
template <class Sampler>
std::vector<double> magnitudes(const Sampler& sampler, double p, const particle& hypothesis, const slab& s, int slices, int n, std::uint64_t seed) {
  const slab slice = split(s, slices);
  std::vector<double> out;
  for (int i = 0; i < n; ++i) {
    random_stream random(seed, static_cast<std::uint64_t>(i), 0);
    vector<double, 2> sum = vector<double, 2>::Zero();
    for (int j = 0; j < slices; ++j) sum += sampler.sample(p, hypothesis, slice, 1.0, random);
    out.push_back(std::abs(sum.x()));
    out.push_back(std::abs(sum.y()));
  }
  std::sort(out.begin(), out.end());
  return out;
}

double below(const std::vector<double>& sorted, double x) {
  return static_cast<double>(std::lower_bound(sorted.begin(), sorted.end(), x) - sorted.begin()) / static_cast<double>(sorted.size());
}

/// Moliere's distribution without approximation: probability that a projected angle is below x in magnitude, by Hankel transform of
/// dn = 2 chi_c^2 theta dtheta / (theta^2 + chi_a^2)^2, whose exponent is (chi_c^2 / chi_a^2) (1 - eta chi_a K1(eta chi_a)).
/// x and chi_a in units of chi_c.
double moliere_below(double x, double chi_a) {
  constexpr double largest_eta = 14.0;
  constexpr int steps = 7000;
  constexpr double h = largest_eta / steps;
  double sum = 0.5 * x;
  for (int i = 1; i < steps; ++i) {
    const double eta = i * h;
    sum += std::sin(eta * x) / eta * std::exp(-(1.0 - eta * chi_a * std::cyl_bessel_k(1.0, eta * chi_a)) / (chi_a * chi_a));
  }
  return 2.0 / constants::pi * sum * h;
}

}  // namespace

TEST_CASE("Gaussian scattering has the variance of its policy in both projections", "[particle_to_hit]") {
  constexpr int n = 20000;
  const double variance = highland_scattering{}.variance(200.0, muon_plus, doublet, 1.0);
  double xx = 0.0, yy = 0.0, xy = 0.0;
  random_stream random(5, 0, 0);
  for (int i = 0; i < n; ++i) {
    const vector<double, 2> a = gaussian_scattering<>{}.sample(200.0, muon_plus, doublet, 1.0, random);
    xx += a.x() * a.x() / n;
    yy += a.y() * a.y() / n;
    xy += a.x() * a.y() / n;
  }
  const double five = 5.0 / std::sqrt(static_cast<double>(n));
  CHECK(std::abs(xx / variance - 1.0) < five * std::sqrt(2.0));
  CHECK(std::abs(yy / variance - 1.0) < five * std::sqrt(2.0));
  CHECK(std::abs(xy / variance) < five);
}

TEST_CASE("no scattering leaves the direction alone, and so does an empty slab", "[particle_to_hit]") {
  random_stream random(6, 0, 0);
  CHECK(gaussian_scattering<no_scattering>{}.sample(200.0, muon_plus, doublet, 1.0, random).norm() == 0.0);
  CHECK(coulomb_scattering{}.sample(200.0, muon_plus, whole(materials::polystyrene, 0.0), 1.0, random).norm() == 0.0);
  CHECK(coulomb_scattering{}.sample(200.0, muon_plus, whole(materials::vacuum, 10.0), 1.0, random).norm() == 0.0);
}

TEST_CASE("Coulomb scattering follows Moliere's distribution from the core to the tail", "[particle_to_hit]") {
  // An electron, which electrons can turn by any angle as Moliere's theory assumes; p small enough for the nuclei to be points.
  constexpr int n = 40000;
  constexpr double p = 50.0;
  constexpr double alpha = 1.0 / 137.035999;
  const double chi_c = std::sqrt(constants::pi / alpha) * constants::electron_mass / p * std::sqrt(radiation_lengths(doublet) / std::log(287.0 / std::sqrt(6.0)));
  const double chi_a = alpha * constants::electron_mass * std::cbrt(6.0) / (0.885 * p) * std::sqrt(1.13 + 3.76 * 36.0 * alpha * alpha);
  const std::vector<double> sorted = magnitudes(coulomb_scattering{6.0, screening::moliere}, p, electron, doublet, 3, n, 7);
  for (const double x : {0.5, 1.0, 2.0, 3.0, 5.0, 8.0, 15.0, 30.0}) {
    const double expected = moliere_below(x, chi_a / chi_c);
    CAPTURE(x, expected);
    // The small angles as one Gaussian: their excess kurtosis is 1 / (3 (ln r - 1)^2) of a slice, r about 200: 0.02, of which (x^3 - 3 x) phi(x) / 24 < 0.05
    // reaches the distribution, so 1e-3; and five standard deviations.
    CHECK(std::abs(below(sorted, x * chi_c) - expected) < 1e-3 + 5.0 * std::sqrt(expected * (1.0 - expected) / (2.0 * n)));
  }
}

TEST_CASE("Coulomb scattering of muons in a fibre plane has the width that Highland's formula promises", "[particle_to_hit]") {
  for (const double p : {120.0, 200.0, 280.0}) {
    const std::vector<double> sorted = magnitudes(coulomb_scattering{6.0, screening::moliere}, p, muon_plus, doublet, 2, 20000, 8);
    const double width = sorted[static_cast<std::size_t>(0.6827 * static_cast<double>(sorted.size()))];
    const double highland = std::sqrt(highland_scattering{}.variance(p, muon_plus, doublet, 1.0));
    CAPTURE(p, width / highland);
    CHECK(std::abs(width / highland - 1.0) < 0.05);  // Lynch and Dahl: Highland's formula with these constants is good to some per cent here
    CHECK(below(sorted, 3.0 * highland) < 0.99);     // a Gaussian would have 0.9973
    CHECK(below(sorted, 3.0 * highland) > 0.975);
  }
}

TEST_CASE("Wentzel's screening narrows the core and leaves the tail", "[particle_to_hit]") {
  constexpr int n = 100000;
  const std::vector<double> moliere = magnitudes(coulomb_scattering{6.0, screening::moliere}, 200.0, muon_plus, doublet, 1, n, 12);
  const std::vector<double> wentzel = magnitudes(coulomb_scattering{}, 200.0, muon_plus, doublet, 1, n, 13);
  const auto core = [](const std::vector<double>& sorted) { return sorted[static_cast<std::size_t>(0.6827 * static_cast<double>(sorted.size()))]; };
  // Below chi_c the mean square goes as ln(chi_c^2/chi_a^2) - 1, with chi_c^2/chi_a^2 = 220 for 0.63 mm of plastic: 4.4, less ln 1.965 = 0.68 of the core's
  // 15 % in variance; scatters beyond chi_c, which widen the core too, dilute it.
  CHECK(screening::wentzel(6.0) == Approx(1.9646).epsilon(1e-4));
  const double ratio = core(wentzel) / core(moliere);
  CHECK(ratio < 0.97);
  CHECK(ratio > 0.92);
  const double limit = 6.0 * core(moliere);
  const double share = 1.0 - below(moliere, limit);
  CHECK(std::abs(1.0 - below(wentzel, limit) - share) < 5.0 * std::sqrt(2.0 * share / (2.0 * n)));
}

TEST_CASE("electrons cannot turn a heavy particle beyond their mass over its own", "[particle_to_hit]") {
  // With all scatters off electrons but the nuclei's share Z / (Z + 1): the tail beyond the limit falls by that share.
  constexpr int n = 200000;
  const double limit = constants::electron_mass / muon_plus.mass;
  const double beyond_muon = 1.0 - below(magnitudes(coulomb_scattering{}, 280.0, muon_plus, doublet, 1, n, 9), 2.0 * limit);
  const particle pointlike{105.6583755, 1, 0, "toy"};
  const double beta = 280.0 / std::hypot(280.0, muon_plus.mass);
  const double chi_c2 = constants::pi * 137.035999 * constants::electron_mass * constants::electron_mass * radiation_lengths(doublet) /
                        std::log(287.0 / std::sqrt(6.0)) / std::pow(280.0 * beta, 2);
  // Projected Rutherford tail off nuclei: P(|theta_x| > t) = (6/7) chi_c^2 / (2 t^2), raised by the core that it is folded with by 3 <theta_core^2> / t^2.
  const double core2 = highland_scattering{}.variance(280.0, pointlike, doublet, 1.0);
  const double t2 = 4.0 * limit * limit;
  const double expected = 6.0 / 7.0 * chi_c2 / (2.0 * t2) * (1.0 + 3.0 * core2 / t2);
  CAPTURE(beyond_muon, expected);
  CHECK(std::abs(beyond_muon - expected) < 5.0 * std::sqrt(expected / (2.0 * n)) + 0.02 * expected);
}

TEST_CASE("the angles of slices add up to those of the slab", "[particle_to_hit]") {
  constexpr int n = 20000;
  const std::vector<double> one = magnitudes(coulomb_scattering{}, 200.0, muon_plus, doublet, 1, n, 10);
  const std::vector<double> ten = magnitudes(coulomb_scattering{}, 200.0, muon_plus, doublet, 10, n, 11);
  // Kolmogorov and Smirnov, two samples of 2 n: 1.95 sqrt(2 / (2 n)) at a chance of 1e-3; and 2e-3 for the Gaussian of the small angles.
  double distance = 0.0;
  for (std::size_t i = 0; i < one.size(); i += 50) distance = std::max(distance, std::abs(below(ten, one[i]) - static_cast<double>(i) / static_cast<double>(one.size())));
  CHECK(distance < 1.95 / std::sqrt(static_cast<double>(n)) + 2e-3);
}

TEST_CASE("turning keeps the length and turns by the angle, about two axes at right angles", "[particle_to_hit]") {
  for (const vector<double, 3>& momentum : {vector<double, 3>(0.0, 0.0, 200.0), vector<double, 3>(150.0, 1.0, -2.0), vector<double, 3>(-30.0, 40.0, 90.0)}) {
    const vector<double, 3> first = turned_by(momentum, {0.01, 0.0});
    const vector<double, 3> second = turned_by(momentum, {0.0, 0.01});
    const double p = momentum.norm();
    CHECK(first.norm() == Approx(p).epsilon(1e-14));
    CHECK((first - momentum).norm() == Approx(2.0 * p * std::sin(0.005)).epsilon(1e-10));  // chord of 0.01 rad
    CHECK((second - momentum).norm() == Approx(2.0 * p * std::sin(0.005)).epsilon(1e-10));
    const vector<double, 3> sideways_1 = first - first.dot(momentum) / (p * p) * momentum;
    const vector<double, 3> sideways_2 = second - second.dot(momentum) / (p * p) * momentum;
    CHECK(sideways_1.dot(sideways_2) == Approx(0.0).margin(1e-10 * p));
    CHECK(turned_by(momentum, {0.0, 0.0}) == momentum);
  }
}
