// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <scifi/kalman/apply_gate.hpp>
#include <scifi/kalman/gate.hpp>
#include <scifi/kalman/joseph.hpp>

#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

TEST_CASE("a rejected measurement leaves the estimate and is marked, with its chi2 kept", "[kalman]") {
  const auto prior = kalman::uncorrelated(Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(1.0, 1.0));
  const auto u = kalman::joseph{}(prior, models::position{10.0, 1.0});  // chi2 = 100 / 2
  auto out = u;
  kalman::detail::apply_gate<1>(kalman::chi2_gate{49.0}, prior, out.posterior, out);
  CHECK(out.outlier);
  CHECK(out.posterior.mean == prior.mean);
  CHECK(out.posterior.covariance == prior.covariance);
  CHECK(out.chi2 == Approx(50.0));
  CHECK(out.status.ok());
  out = u;
  kalman::detail::apply_gate<1>(kalman::chi2_gate{51.0}, prior, out.posterior, out);
  CHECK_FALSE(out.outlier);
  CHECK(out.posterior.mean(0) == Approx(5.0));
}

TEST_CASE("an empty optional and every alternative of a variant are visited", "[kalman]") {
  const auto size = [](const auto& m) { return kalman::max_measurement_dimension<std::remove_cvref_t<decltype(m)>>; };
  using mixed = std::variant<models::position, models::linear_values<2, 3>>;
  CHECK(kalman::detail::visit_measurement(std::optional<models::position>{}, size) == 0);
  CHECK(kalman::detail::visit_measurement(std::optional(models::position{0.0, 1.0}), size) == 1);
  CHECK(kalman::detail::visit_measurement(mixed(models::linear_values<2, 3>{scifi::vector<double, 3>::Zero(), scifi::matrix<double, 3, 2>::Zero(), scifi::matrix<double, 3, 3>::Identity()}), size) == 3);
}
