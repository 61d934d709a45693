// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <cmath>

#include <scifi/material/kinematics.hpp>

#include "dual.hpp"

using namespace scifi;
using scifi::test::dual;

TEST_CASE("The largest transfer is that of a head-on collision", "[material]") {
  // The projectile reversed in the centre of mass: T = 2 m_e p^2 / s', from boosts alone.
  for (const particle& h : {muon_plus, pion_plus, proton, electron}) {
    for (const double p : {20.0, 200.0, 5000.0}) {
      const auto k = ionisation_kinematics_of(p, h);
      const double m_e = constants::electron_mass;
      const double energy = std::hypot(p, h.mass);
      const double boost = p / (energy + m_e);  // velocity of the centre of mass
      const double boost_gamma = 1.0 / std::sqrt((1.0 - boost) * (1.0 + boost));
      const double p_star = boost_gamma * boost * m_e;  // electron's momentum there
      const double e_star = boost_gamma * m_e;
      const double transfer = boost_gamma * (e_star + boost * p_star) - m_e;  // after reversal, back in the laboratory
      CHECK(k.largest_transfer == Approx(transfer).epsilon(1e-9));
      CHECK(k.beta_squared == Approx(p * p / (energy * energy)).epsilon(1e-14));
      CHECK(k.gamma == Approx(energy / h.mass).epsilon(1e-14));
    }
  }
}

TEST_CASE("An electron can give all its kinetic energy to an electron", "[material]") {
  const auto k = ionisation_kinematics_of(3.0, electron);
  CHECK(k.largest_transfer == Approx(std::hypot(3.0, electron.mass) - electron.mass).epsilon(1e-12));
}

TEST_CASE("The logarithmic derivative of the largest transfer is its derivative", "[material]") {
  for (const double p : {15.0, 200.0, 4000.0}) {
    const dual x = test::variable(p, 0);
    const auto k = ionisation_kinematics_of(x, muon_plus);
    const double expected = k.largest_transfer.derivatives()(0) / k.largest_transfer.value() * muon_plus.mass;
    CHECK(k.d_log_largest_transfer.value() == Approx(expected).epsilon(1e-12));
  }
}
