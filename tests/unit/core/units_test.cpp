// SPDX-License-Identifier: MPL-2.0
#include <scifi/core/units.hpp>

#include <cmath>

#include "support/catch.hpp"

using namespace scifi::literals;
namespace units = scifi::units;

TEST_CASE("a particle of one elementary charge and 0.299792458 GeV/c bends in one tesla with a radius of one metre", "[core]") {
  // p = q B R in SI units: 1.602176634e-19 C * 1 T * 1 m; 1 MeV/c = 1.602176634e-13 J / 299792458 m/s.
  const double si_momentum = 1.602176634e-19 * 1.0 * 1.0;
  const double mev_per_c = 1.602176634e-13 / 299792458.0;
  const double pt = si_momentum / mev_per_c * units::MeV;
  CHECK(pt == Approx(0.299792458 * units::GeV).epsilon(1e-15));
  CHECK(pt / (1.0 * units::tesla) == Approx(1.0 * units::m).epsilon(1e-15));
}

TEST_CASE("lengths, times, energies and angles are multiples of the native ones", "[core]") {
  CHECK(10.0 * units::mm == units::cm);
  CHECK(100.0 * units::cm == units::m);
  CHECK(1000.0 * units::um == Approx(units::mm).epsilon(1e-15));
  CHECK(1000.0 * units::ns == units::us);
  CHECK(1e6 * units::eV == Approx(units::MeV).epsilon(1e-15));
  CHECK(1e3 * units::keV == Approx(units::MeV).epsilon(1e-15));
  CHECK(1e3 * units::MeV == units::GeV);
  CHECK(1e3 * units::mrad == Approx(units::rad).epsilon(1e-15));
  CHECK(180.0 * units::degree == Approx(std::acos(-1.0)).epsilon(1e-15));
}

TEST_CASE("literals say what the constants say", "[core]") {
  CHECK(1.5_m == 1.5 * units::m);
  CHECK(2.0_cm == 20.0_mm);
  CHECK(7.0_um == 7.0 * units::um);
  CHECK(200.0_MeV == 200.0);
  CHECK(4.0_T == 4.0 * units::tesla);
  CHECK(3.0_mrad == 3.0 * units::mrad);
  CHECK(90.0_deg == 90.0 * units::degree);
  static_assert(3.0_mm == 3.0);
}
