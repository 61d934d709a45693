// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <scifi/kalman/node_view.hpp>

#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

TEST_CASE("a measurement goes into a node and comes out in matrices of its size", "[kalman]") {
  std::mt19937_64 engine(24);
  kalman::node<double, 4, 3> n;
  int seen_dimension = -1;
  kalman::detail::with_measurement(n, [&](const auto&) { seen_dimension = 0; });
  CHECK(seen_dimension == -1);

  const auto h = models::random_matrix<2, 4>(engine);
  const auto s = models::random_covariance<2>(engine);
  kalman::detail::assign_bounded(n.residual, scifi::vector<double, 2>(1.0, 2.0));
  kalman::detail::assign_bounded(n.projection, h);
  kalman::detail::assign_bounded(n.residual_covariance, s);
  kalman::detail::assign_bounded(n.measurement_covariance, s);
  n.measurement_dimension = 2;
  CHECK(n.projection == h);
  kalman::detail::with_measurement(n, [&](const auto& seen) {
    seen_dimension = static_cast<int>(seen.residual.size());
    if constexpr (std::remove_cvref_t<decltype(seen)>::size == 2) CHECK(seen.jacobian == h);
    CHECK(seen.residual(1) == 2.0);
  });
  CHECK(seen_dimension == 2);
}
