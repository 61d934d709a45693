// SPDX-License-Identifier: MPL-2.0
#include <scifi/kalman/advance.hpp>

#include <limits>
#include <optional>
#include <random>

#include <scifi/core/lane.hpp>
#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/iterated.hpp>
#include <scifi/kalman/plain.hpp>
#include <scifi/kalman/square_root.hpp>
#include <scifi/kalman/symmetric_form.hpp>

#include "laws/update_laws.hpp"
#include "support/catch.hpp"
#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

namespace {

constexpr double rounding = 1.0e-12;

template <int N, int M, class Update, class Gate>
void check_against_two_calls(const Update& update, const Gate& gate) {
  std::mt19937_64 engine(10 * N + M);
  const kalman::filter f{models::step_transition{}, models::step_noise{}, update, gate};
  kalman::estimate<double, N> e{models::random_matrix<N, 1>(engine), models::random_covariance<N>(engine)};
  for (int k = 0; k < 20; ++k) {
    const models::matrix_step<N> step{0.5 * models::random_matrix<N, N>(engine), models::random_covariance<N>(engine)};
    const models::linear_values<N, M> m{3.0 * models::random_matrix<M, 1>(engine), models::random_matrix<M, N>(engine), models::random_covariance<M>(engine)};
    const auto expected = f.update(f.predict(e, step), m);
    const auto out = f.advance(e, step, m);
    REQUIRE(out.status == expected.status);
    CHECK(out.outlier == expected.outlier);
    CHECK(out.chi2 == Approx(expected.chi2).epsilon(rounding));
    CHECK(laws::estimate_distance(expected.posterior, e) < rounding);
  }
}

template <class Update>
void check_update(const Update& update) {
  check_against_two_calls<1, 1>(update, kalman::no_gate{});
  check_against_two_calls<5, 1>(update, kalman::chi2_gate{1.0});
  check_against_two_calls<6, 3>(update, kalman::no_gate{});
}

}  // namespace

TEST_CASE("a step in place ends where predict and update do, with every update policy", "[kalman]") {
  check_update(kalman::symmetric_form{});
  check_update(kalman::joseph{});
  check_update(kalman::plain{});
  check_update(kalman::square_root{});  // has no form in place
  check_update(kalman::iterated{});
}

TEST_CASE("a step in place takes optional steps and measurements", "[kalman]") {
  const kalman::filter f{models::constant_velocity{}, models::white_acceleration{1.0}, kalman::symmetric_form{}};
  const auto start = kalman::uncorrelated(Eigen::Vector2d(0.0, 1.0), Eigen::Vector2d(1.0, 1.0));
  auto e = start;
  CHECK(f.advance(e, std::optional<double>{}, std::optional<models::position>{}).status.ok());
  CHECK(e.mean == start.mean);
  CHECK(e.covariance == start.covariance);
  CHECK(f.advance(e, 1.0, std::optional(models::position{2.0, 0.5})).status.ok());
  CHECK(laws::estimate_distance(f.update(f.predict(start, 1.0), models::position{2.0, 0.5}).posterior, e) < rounding);
}

TEST_CASE("a step in place that fails says where and leaves the estimate as it was before that part", "[kalman]") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const kalman::filter f{models::constant_velocity{}, models::white_acceleration{1.0}, kalman::symmetric_form{}};
  const auto start = kalman::uncorrelated(Eigen::Vector2d(0.0, 1.0), Eigen::Vector2d(1.0, 1.0));
  auto e = start;
  CHECK(f.advance(e, nan, models::position{2.0, 0.5}).status == kalman::status{kalman::step_kind::predict, kalman::reason::not_finite});
  CHECK(e.mean == start.mean);
  CHECK(e.covariance == start.covariance);
  CHECK(f.advance(e, 1.0, models::position{nan, 0.5}).status == kalman::status{kalman::step_kind::update, kalman::reason::not_finite});
  CHECK(laws::estimate_distance(f.predict(start, 1.0).estimate, e) < rounding);
}
