// SPDX-License-Identifier: MPL-2.0
#include <scifi/hit_to_digit/light_yield.hpp>

#include "support/catch.hpp"

TEST_CASE("the chain of factors gives 174.7 photo-electrons per MeV", "[hit_to_digit]") {
  // 3047.1 * 0.056 * 1.6 = 273.02; * 0.64 = 174.73.
  CHECK(scifi::light_yield{}.per_mev() == Approx(174.73).margin(0.005));
  CHECK(scifi::light_yield{}.photo_electrons(0.1) == Approx(17.473).margin(0.0005));
  CHECK(scifi::light_yield{}.photo_electrons(0.0) == 0.0);
}

TEST_CASE("a fibre without a mirror gives 1/1.6 of the light", "[hit_to_digit]") {
  scifi::light_yield bare;
  bare.mirror = 0.0;
  CHECK(bare.per_mev() == Approx(174.73 / 1.6).margin(0.005));
}
