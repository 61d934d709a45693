// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <scifi/kalman/updated.hpp>

namespace kalman = scifi::kalman;

TEST_CASE("the estimate and the status are found in whatever a step returns", "[kalman]") {
  const kalman::estimate<double, 1> e = kalman::uncorrelated(2.0, 1.0);
  const kalman::predicted<double, 1> p{e, {}, {}, {kalman::step_kind::predict, kalman::reason::not_finite}};
  kalman::updated<double, 1, 3> u{e, {}, {}, {}, {}};
  CHECK(&kalman::detail::estimate_in(e) == &e);
  CHECK(&kalman::detail::estimate_in(p) == &p.estimate);
  CHECK(&kalman::detail::estimate_in(u) == &u.posterior);
  CHECK(kalman::detail::status_in(e).ok());
  CHECK(kalman::detail::status_in(p).why == kalman::reason::not_finite);
  CHECK(u.measurement_dimension() == 3);
  CHECK_FALSE(u.outlier);
  STATIC_REQUIRE_FALSE(kalman::detail::prior<Eigen::Vector2d>);
}
