// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <type_traits>

#include <scifi/kalman/node.hpp>

namespace kalman = scifi::kalman;

TEST_CASE("a node starts without a measurement and keeps everything inside itself", "[kalman]") {
  kalman::node<double, 5, 3> n;
  CHECK(n.measurement_dimension == 0);
  CHECK(n.residual.size() == 0);
  CHECK(n.status.why == kalman::reason::not_reached);
  CHECK_FALSE(n.outlier);
  n.residual.resize(3);
  n.projection.resize(3, 5);
  const auto inside = [&n](const void* p) { return p >= static_cast<const void*>(&n) && p < static_cast<const void*>(&n + 1); };
  CHECK(inside(n.residual.data()));
  CHECK(inside(n.projection.data()));
  STATIC_REQUIRE(std::is_same_v<kalman::count<double>, int>);
}

TEST_CASE("a run that did nothing has not failed", "[kalman]") {
  const kalman::run_result<double> r;
  CHECK(r.status.ok());
  CHECK(r.failed_at == kalman::no_failure);
  CHECK(r.ndf == 0);
}
