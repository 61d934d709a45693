// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <limits>

#include <scifi/kalman/gate.hpp>

#include "laws/gate_laws.hpp"

namespace kalman = scifi::kalman;

TEST_CASE("the chi2 gate cuts at its threshold times the dimension", "[kalman]") {
  constexpr kalman::chi2_gate gate{9.0};
  CHECK(gate(9.0, 1));
  CHECK_FALSE(gate(9.001, 1));
  CHECK(gate(18.0, 2));
  CHECK_FALSE(gate(19.0F, 2));
  CHECK_FALSE(gate(std::numeric_limits<double>::quiet_NaN(), 1));
  CHECK(laws::gate_is_monotone(gate, 1, 20.0));
  CHECK(laws::gate_is_monotone(kalman::no_gate{}, 1, 20.0));
}
