// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <cmath>

#include <scifi/material/momentum.hpp>

#include "dual.hpp"

using namespace scifi;

namespace {
constexpr double mass = 105.6583755;
}

TEST_CASE("The energy goes down by what is lost", "[material]") {
  for (const double p : {30.0, 200.0, 3000.0}) {
    for (const double lost : {-20.0, 0.0, 0.1, 3.0}) {
      const double after = momentum_after_loss(p, mass, lost).p_new;
      CHECK(std::hypot(after, mass) == Approx(std::hypot(p, mass) - lost).epsilon(1e-14));
    }
  }
  CHECK(momentum_after_loss(200.0, mass, 0.0).p_new == 200.0);
}

TEST_CASE("A gain takes back a loss", "[material]") {
  const double down = momentum_after_loss(150.0, mass, 12.5).p_new;
  CHECK(momentum_after_loss(down, mass, -12.5).p_new == Approx(150.0).epsilon(1e-14));
}

TEST_CASE("Tiny losses are not lost in rounding", "[material]") {
  // dp = -loss/beta to first order; a difference of energies would keep only six digits of it.
  const double lost = 1e-8;
  const double p = 200.0;
  const double change = momentum_after_loss(p, mass, lost).p_new - p;
  CHECK(change == Approx(-lost * std::hypot(p, mass) / p).margin(6e-14));  // two units in the last place of p
}

TEST_CASE("The derivatives of the new momentum agree with automatic differentiation", "[material]") {
  for (const double p : {40.0, 200.0, 2000.0}) {
    for (const double lost : {-5.0, 0.7, 5.0}) {
      const auto change = momentum_after_loss(test::variable(p, 0), mass, test::variable(lost, 1));
      CHECK(change.d_new_d_p.value() == Approx(change.p_new.derivatives()(0)).epsilon(1e-12));
      CHECK(change.d_new_d_loss.value() == Approx(change.p_new.derivatives()(1)).epsilon(1e-12));
    }
  }
}

TEST_CASE("A particle that loses all its kinetic energy has stopped: not a number", "[material]") {
  const double p = 50.0;
  const double kinetic = std::hypot(p, mass) - mass;
  CHECK(std::isfinite(momentum_after_loss(p, mass, kinetic * (1.0 - 1e-9)).p_new));
  // Also where p^2 - loss (2E - loss) has turned positive again, loss > E + m.
  for (const double lost : {kinetic * (1.0 + 1e-9), kinetic + mass, 2.0 * kinetic + 3.0 * mass}) {
    const auto change = momentum_after_loss(p, mass, lost);
    CHECK(std::isnan(change.p_new));
    CHECK(std::isnan(change.d_new_d_p));
    CHECK(std::isnan(change.d_new_d_loss));
  }
}

TEST_CASE("Single precision gives the new momentum to single precision", "[material]") {
  CHECK(static_cast<double>(momentum_after_loss(200.0f, mass, 0.13f).p_new) == Approx(momentum_after_loss(200.0, mass, 0.13).p_new).epsilon(3e-7));
}
