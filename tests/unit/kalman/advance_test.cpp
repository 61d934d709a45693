// SPDX-License-Identifier: MPL-2.0
#include <scifi/kalman/advance.hpp>

#include <cmath>
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

/// A model that can write what it works out where it is to stay, and whose noise asks for what the propagator hands on beside it.
template <bool InPlace>
struct swinging {
  double rate = 0.3;
  struct moved_by : kalman::propagated_view<double, 2> {
    double angle;
  };
  kalman::propagated<double, 2> propagate(const scifi::vector<double, 2>& x, double dt) const {
    kalman::propagated<double, 2> end;
    write({end.state, end.jacobian}, x, dt);
    return end;
  }
  moved_by propagate_into(const kalman::propagated_view<double, 2>& end, const scifi::vector<double, 2>& x, double dt) const
    requires InPlace
  {
    write(end, x, dt);
    return {end, rate * dt};
  }
  void write(const kalman::propagated_view<double, 2>& end, const scifi::vector<double, 2>& x, double dt) const {
    const double c = std::cos(rate * dt), s = std::sin(rate * dt);
    end.jacobian << c, s, -s, c;
    end.state << c * x(0) + s * x(1), c * x(1) - s * x(0);
  }
};
struct swinging_noise {
  double rate = 0.3;
  scifi::matrix<double, 2, 2> covariance(const scifi::vector<double, 2>&, double dt, const kalman::propagated<double, 2>& moved) const {
    return rate * dt * moved.jacobian * moved.jacobian.transpose();
  }
  void covariance_into(scifi::matrix<double, 2, 2>& q, const scifi::vector<double, 2>&, double, const swinging<true>::moved_by& moved) const {
    q = moved.angle * moved.jacobian * moved.jacobian.transpose();
  }
};

}  // namespace

TEST_CASE("a model that writes where its results are to stay moves an estimate as one that returns them", "[kalman]") {
  const kalman::filter returning{swinging<false>{}, swinging_noise{}, kalman::symmetric_form{}};
  const kalman::filter writing{swinging<true>{}, swinging_noise{}, kalman::symmetric_form{}};
  STATIC_REQUIRE(kalman::detail::models_in_place<swinging<true>, swinging_noise, double, 2, double>);
  STATIC_REQUIRE_FALSE(kalman::detail::models_in_place<swinging<false>, swinging_noise, double, 2, double>);
  const kalman::estimate<double, 2> e{scifi::vector<double, 2>(1.0, -2.0), scifi::matrix<double, 2, 2>::Identity()};
  const auto a = returning.predict(e, 1.7), b = writing.predict(e, 1.7);
  CHECK(a.estimate.mean == b.estimate.mean);
  CHECK(a.jacobian == b.jacobian);
  CHECK((a.noise - b.noise).norm() < rounding);
  CHECK(laws::estimate_distance(a.estimate, b.estimate) < rounding);
}

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
