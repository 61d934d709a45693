// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <cmath>

#include <scifi/material/highland.hpp>
#include <scifi/material/materials.hpp>

#include "dual.hpp"

using namespace scifi;

namespace {

double theta0(double p, const particle& h, double t) { return std::sqrt(highland_variance(p, h, t, t)); }

// Width of the Gaussian that fits Moliere's core with the fraction F = 0.98 of the tracks: Lynch, Dahl, NIM B 58 (1991) 6, eq. 7, for an
// element; thickness in g/cm2. Theory, where Highland's formula is a fit to it.
double lynch_dahl(double p, const particle& h, double z, double a, double thickness) {
  const double fraction = 0.98;
  const double beta = p / std::hypot(p, h.mass);
  const double alpha = 1.0 / 137.036;
  const double characteristic2 = 0.157 * z * (z + 1.0) * thickness / (a * p * p * beta * beta);
  const double screening2 = 2.007e-5 * std::pow(z, 2.0 / 3.0) * (1.0 + 3.34 * std::pow(z * alpha / beta, 2)) / (p * p);
  const double v = 0.5 * characteristic2 / screening2 / (1.0 - fraction);
  return std::sqrt(characteristic2 / (1.0 + fraction * fraction) * ((1.0 + v) / v * std::log(1.0 + v) - 1.0));
}

}  // namespace

TEST_CASE("Highland's width is 13.6 MeV over beta p at one radiation length", "[material]") {
  // beta -> 1: the logarithm vanishes at x = X0. PDG 2024 eq. 34.16.
  CHECK(theta0(1e6, muon_plus, 1.0) == Approx(13.6 / 1e6).epsilon(1e-6));
  // And at 1 % it is 13.6 * 0.1 * (1 + 0.038 ln 0.01) = 13.6 * 0.0825 (by hand).
  CHECK(theta0(1e6, muon_plus, 0.01) == Approx(13.6e-6 * 0.1 * 0.82500354).epsilon(1e-6));
}

TEST_CASE("A slow muon scatters as computed by hand", "[material]") {
  // p = 105.6583755 = m: beta^2 = 1/2, E/p = sqrt 2; x/X0 = 1/2, so that ln(x/(X0 beta^2)) = 0.
  CHECK(theta0(105.6583755, muon_plus, 0.5) == Approx(13.6 / 105.6583755).epsilon(1e-12));
}

TEST_CASE("Highland agrees with the fit to Moliere's theory to the 11 % it claims", "[material]") {
  const auto check = [](double z, double a, double x0, double p, const particle& h, double t) {
    INFO("Z = " << z << ", p = " << p << ", x/X0 = " << t);
    CHECK(theta0(p, h, t) == Approx(lynch_dahl(p, h, z, a, t * x0)).epsilon(0.11));
  };
  for (const double t : {1e-3, 1e-2, 0.1, 1.0, 10.0}) {
    for (const double p : {150.0, 200.0, 1000.0}) {
      check(6, 12.011, 42.70, p, muon_plus, t);
      check(13, 26.98, 24.01, p, muon_plus, t);
      check(13, 26.98, 24.01, p, pion_minus, t);
    }
  }
}

TEST_CASE("Slices share the layer's variance and add up to it", "[material]") {
  const double layer = 0.0152;
  const double whole_layer = highland_variance(200.0, muon_plus, layer, layer);
  for (const int n : {2, 7, 1000}) CHECK(n * highland_variance(200.0, muon_plus, layer / n, layer) == Approx(whole_layer).epsilon(1e-13));
  // Slices that forget their layer scatter too little: the mistake this interface is made against.
  CHECK(1000 * highland_variance(200.0, muon_plus, layer / 1000, layer / 1000) < 0.5 * whole_layer);
}

TEST_CASE("No thickness scatters exactly nothing, and the variance is never negative", "[material]") {
  CHECK(highland_variance(200.0, muon_plus, 0.0, 0.0) == 0.0);
  CHECK(highland_variance(200.0, muon_plus, 0.0, 0.01) == 0.0);
  const auto d = highland_variance(test::variable(200.0, 0), muon_plus, test::constant(0.0), test::constant(0.0));
  CHECK(d.value() == 0.0);
  CHECK(d.derivatives()(0) == 0.0);
  for (const double t : {1e-300, 1e-15, 1e-12, 1e-11}) CHECK(highland_variance(1e5, muon_plus, t, t) >= 0.0);
  CHECK(highland_variance(1e5, muon_plus, 3e-12, 3e-12) == 0.0);  // below exp(-1/0.038) = 3.7e-12
  CHECK(highland_variance(1e5, muon_plus, 5e-12, 5e-12) > 0.0);
}

TEST_CASE("Scattering grows with the charge, in front and in the logarithm", "[material]") {
  const particle alpha_like{muon_plus.mass, 2, 0, "z=2"};
  const double t = 0.01, p = 300.0, beta2 = p * p / (p * p + muon_plus.mass * muon_plus.mass);
  const double ratio = 2.0 * (1.0 + 0.038 * std::log(t * 4.0 / beta2)) / (1.0 + 0.038 * std::log(t / beta2));
  CHECK(theta0(p, alpha_like, t) / theta0(p, muon_plus, t) == Approx(ratio).epsilon(1e-12));
  CHECK(theta0(p, muon_minus, t) == theta0(p, muon_plus, t));
}

TEST_CASE("Single precision and dual numbers follow Highland's formula", "[material]") {
  CHECK(static_cast<double>(highland_variance(200.0f, muon_plus, 0.01f, 0.01f)) == Approx(highland_variance(200.0, muon_plus, 0.01, 0.01)).epsilon(2e-6));
  const auto at = [](double p) { return highland_variance(p, muon_plus, 0.002, 0.01); };
  const auto d = highland_variance(test::variable(200.0, 0), muon_plus, test::constant(0.002), test::constant(0.01));
  // Central difference with step 0.02: truncation (step/p)^2 ~ 1e-8 relative, rounding 1e-16 p/step = 1e-12.
  CHECK(d.derivatives()(0) == Approx((at(200.02) - at(199.98)) / 0.04).epsilon(1e-6));
}
