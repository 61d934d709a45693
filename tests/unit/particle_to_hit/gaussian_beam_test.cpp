// SPDX-License-Identifier: MPL-2.0
#include <scifi/particle_to_hit/gaussian_beam.hpp>

#include <cmath>
#include <stdexcept>
#include <string>

#include <Eigen/LU>

#include <scifi/core/units.hpp>

#include "support/catch.hpp"
#include "support/message_of.hpp"

using namespace scifi;

namespace {

/// Sample covariance of (x, px, y, py).
matrix<double, 4, 4> covariance_of(const gaussian_beam& beam, int direction, double field, int n) {
  random_stream random(1, 0, 0);
  matrix<double, 4, 4> sum = matrix<double, 4, 4>::Zero();
  for (int i = 0; i < n; ++i) {
    const moving_particle m = beam.shoot(5.0, direction, field, random);
    REQUIRE(m.position.z() == 5.0);
    REQUIRE(m.momentum.z() * direction > 0.0);
    const vector<double, 4> v{m.position.x(), m.momentum.x(), m.position.y(), m.momentum.y()};
    sum += v * v.transpose() / n;
  }
  return sum;
}

}  // namespace

TEST_CASE("the beam has its emittance and Twiss parameters", "[particle_to_hit]") {
  constexpr int n = 40000;
  for (const int direction : {1, -1}) {
    gaussian_beam beam;
    beam.alpha = 0.7;
    const matrix<double, 4, 4> c = covariance_of(beam, direction, 0.0, n);
    const double me = beam.hypothesis.mass * beam.emittance;
    // Relative spread of a sample variance sqrt(2/n), of the fourth root of the determinant of four variances sqrt(1/(2 n)).
    const double five = 5.0 * std::sqrt(2.0 / n);
    CHECK(std::pow(c.determinant(), 0.25) == Approx(me).epsilon(0.5 * five));
    CHECK(c(0, 0) == Approx(me * beam.beta / beam.pz).epsilon(five));
    CHECK(c(2, 2) == Approx(me * beam.beta / beam.pz).epsilon(five));
    CHECK(c(0, 1) == Approx(-me * beam.alpha).epsilon(3.0 * five));
    CHECK(c(1, 1) == Approx(me * beam.pz * (1.0 + beam.alpha * beam.alpha) / beam.beta).epsilon(five));
    CHECK(std::abs(c(0, 2)) < five * c(0, 0));
    CHECK(std::abs(c(1, 3)) < five * c(1, 1));
  }
}

TEST_CASE("in a field a beam without canonical angular momentum turns about the axis as Larmor says", "[particle_to_hit]") {
  constexpr int n = 40000;
  const double field = 3.0 * units::tesla;
  for (const particle& species : {muon_plus, muon_minus}) {
    gaussian_beam beam;
    beam.hypothesis = species;
    beam.beta = 2.0 * beam.pz / field;  // matched: 1/kappa
    const matrix<double, 4, 4> c = covariance_of(beam, 1, field, n);
    const double five = 5.0 * std::sqrt(2.0 / n);
    // <x Py - y Px> = 0 with P = p + q A, A = B/2 (-y, x): <x py - y px> = -q B <r^2> / 2.
    const double turned = -0.5 * species.charge * field * (c(0, 0) + c(2, 2));
    CHECK(c(0, 3) - c(2, 1) == Approx(turned).epsilon(2.0 * five));
    CHECK(std::pow(c.determinant(), 0.25) == Approx(beam.hypothesis.mass * beam.emittance).epsilon(0.5 * five));
  }
  gaussian_beam beam;
  beam.beta = 2.0 * beam.pz / field;
  beam.canonical = 1.0;  // cancels the turn
  const matrix<double, 4, 4> c = covariance_of(beam, 1, field, n);
  CHECK(std::abs(c(0, 3)) < 5.0 * std::sqrt(c(0, 0) * c(3, 3) / n));
}

TEST_CASE("the momentum has its mean and spread", "[particle_to_hit]") {
  gaussian_beam beam;
  random_stream random(3, 0, 0);
  constexpr int n = 20000;
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < n; ++i) {
    const double pz = beam.shoot(0.0, -1, 0.0, random).momentum.z();
    sum -= pz / n;
    squares += (pz + beam.pz) * (pz + beam.pz) / n;
  }
  CHECK(std::abs(sum - 200.0) < 5.0 * 10.0 / std::sqrt(static_cast<double>(n)));
  CHECK(squares == Approx(100.0).epsilon(5.0 * std::sqrt(2.0 / n)));
}

TEST_CASE("a Gaussian beam that cannot be is refused by name", "[particle_to_hit]") {
  const auto refused = [](auto change, const char* culprit) {
    gaussian_beam beam;
    change(beam);
    const std::string message = test::message_of<std::invalid_argument>([&beam] { beam.check(); });
    CAPTURE(culprit, message);
    CHECK(message.find(culprit) != std::string::npos);
  };
  CHECK_NOTHROW(gaussian_beam{}.check());
  refused([](gaussian_beam& b) { b.emittance = -1.0; }, "emittance");
  refused([](gaussian_beam& b) { b.beta = 0.0; }, "beta");
  refused([](gaussian_beam& b) { b.alpha = std::nan(""); }, "alpha");
  refused([](gaussian_beam& b) { b.pz = 0.0; }, "pz");
  refused([](gaussian_beam& b) { b.pz_spread = 300.0; }, "spread");
  refused([](gaussian_beam& b) { b.hypothesis.charge = 0; }, "charged");
}
