// SPDX-License-Identifier: MPL-2.0
#include <scifi/core/linalg.hpp>
#include <scifi/core/units.hpp>

int main() {
  const scifi::matrix<double, 2, 2> m = scifi::matrix<double, 2, 2>::Identity() * scifi::units::cm;
  return scifi::symmetrised(m) == m ? 0 : 1;
}
