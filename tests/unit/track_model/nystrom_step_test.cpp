// SPDX-License-Identifier: MPL-2.0
#include <scifi/track_model/nystrom_step.hpp>

#include <Eigen/Geometry>

#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include <cmath>
#include <numbers>

#include <scifi/core/units.hpp>
#include <scifi/field/graded_field.hpp>
#include <scifi/field/uniform_field.hpp>
#include <scifi/track_model/slope_state.hpp>

#include "lorentz.hpp"
#include "support/catch.hpp"

using namespace scifi;

namespace {

const graded_field graded{3.0 * units::tesla, 0.8e-3 * units::tesla};
/// No component and hardly a derivative is zero; neither free of sources nor of currents, which a step does not ask.
struct skew_field {
  vector<double, 3> operator()(const vector<double, 3>& r) const {
    return {0.21 + 3e-4 * r.z() + 2e-5 * r.x() * r.y(), -0.33 - 4e-4 * r.x(), 0.7 + 5e-4 * r.y()};
  }
  field_and_gradient<double> with_gradient(const vector<double, 3>& r) const {
    field_and_gradient<double> out{(*this)(r), matrix<double, 3, 3>::Zero()};
    out.gradient.row(0) << 2e-5 * r.y(), 2e-5 * r.x(), 3e-4;
    out.gradient(1, 0) = -4e-4;
    out.gradient(2, 1) = 5e-4;
    return out;
  }
};
/// The same everywhere on a plane of constant z, and says no gradient.
struct layered_field {
  vector<double, 3> operator()(const vector<double, 3>& r) const { return {0.1, -0.2 + 1e-3 * r.z(), 0.9}; }
};

nystrom_state<double> state_of(double q_over_pz) {
  const planar<double> slope{0.31, -0.17};
  return {{12.0, -34.0}, slope, q_over_pz / detail::path_per_dz(slope)};
}

template <class Field>
double distance(const Field& field, const nystrom_state<double>& start, double z, double h) {
  const auto end = nystrom_step<double, Field>(field, start, z, h).end();
  const double pz = 1.0 / (start.q_over_p * detail::path_per_dz(start.slope));
  const test::moving reference = test::carried_to({{start.position.x, start.position.y, z}, {start.slope.x * pz, start.slope.y * pz, pz}, 1.0}, z + h, field);
  return std::hypot(end.position.x - reference.position[0], end.position.y - reference.position[1]) +
         100.0 * std::hypot(end.slope.x - reference.momentum[0] / reference.momentum[2], end.slope.y - reference.momentum[1] / reference.momentum[2]);
}

}  // namespace

TEST_CASE("the slopes change as the Lorentz force says", "[track_model]") {
  // dp/dz = q p x B / pz, hence dtx/dz = (dpx/dz - tx dpz/dz) / pz.
  const planar<double> u{0.31, -0.17};
  const vector<double, 3> b(0.2, -0.5, 0.9), p = 150.0 * vector<double, 3>(u.x, u.y, 1.0);
  const vector<double, 3> force = p.cross(b) / p.z();
  const planar<double> bent = detail::curvature(u, 1.0 / p.norm(), b);
  CHECK(bent.x == Approx((force.x() - u.x * force.z()) / p.z()).epsilon(1e-14));
  CHECK(bent.y == Approx((force.y() - u.y * force.z()) / p.z()).epsilon(1e-14));
}

TEST_CASE("a step errs with the fifth power of its length, in any field", "[track_model]") {
  for (const double q_over_pz : {1.0 / 180.0, -1.0 / 120.0}) {
    const nystrom_state<double> start = state_of(q_over_pz);
    const auto order = [&](const auto& field, double h) { return std::log2(distance(field, start, 40.0, h) / distance(field, start, 40.0, 0.5 * h)); };
    // The next order adds a share of about (turning angle of the step) / 6 to the ratio; 20 mm turn by 0.1 rad.
    CHECK(order(uniform_field{{0.1, -0.2, 0.9}}, 20.0) == Approx(5.0).margin(0.15));
    CHECK(order(graded, -20.0) == Approx(5.0).margin(0.15));
    CHECK(order(skew_field{}, 20.0) == Approx(5.0).margin(0.15));
  }
}

TEST_CASE("the estimated error exceeds the real one and falls with the fourth power", "[track_model]") {
  const nystrom_state<double> start = state_of(1.0 / 180.0);
  const auto check = [&](const auto& field) {
    for (const double h : {40.0, 20.0, 10.0}) {
      const nystrom_step step(field, start, 0.0, h), half(field, start, 0.0, 0.5 * h);
      CHECK(std::log2(step.error() / half.error()) == Approx(4.0).margin(0.3));
      CHECK(distance(field, start, 0.0, h) < step.error());
    }
  };
  check(uniform_field{{0.1, -0.2, 0.9}});
  check(graded);
  check(skew_field{});
}

TEST_CASE("a step from a field that is known is the step", "[track_model]") {
  const nystrom_state<double> start = state_of(1.0 / 180.0);
  const nystrom_step once(graded, start, 10.0, 15.0);
  const nystrom_step again(graded, start, once.field_at_start(), 10.0, 15.0);
  CHECK(again.end().position.x == once.end().position.x);
  CHECK(again.end().slope.y == once.end().slope.y);
}

TEST_CASE("the derivatives of a step are those of finite differences, by position only where the field tells its gradient", "[track_model]") {
  const nystrom_state<double> start = state_of(1.0 / 180.0);
  const auto check = [&](const auto& field, double z, double h) {
    using step = nystrom_step<double, std::decay_t<decltype(field)>>;
    typename step::derivatives d{};
    d.slope[step::tx_column].x = d.slope[step::ty_column].y = 1.0;
    if constexpr (step::has_gradient) d.position[step::x_column].x = d.position[step::y_column].y = 1.0;
    step(field, start, z, h).transport(d);
    for (std::size_t i = 0; i < step::columns; ++i) {
      INFO("column " << i);
      // Steps small against what each number means; a central difference errs by their square, some 1e-8 of the derivative.
      const double unit = i == step::q_over_p_column ? 1e-7 : i < 2 ? 1e-4 : 1e-2;
      const auto moved = [&](double by) {
        nystrom_state<double> s = start;
        (i == step::tx_column ? s.slope.x : i == step::ty_column ? s.slope.y : i == step::q_over_p_column ? s.q_over_p : i == step::x_column ? s.position.x : s.position.y) += by;
        return step(field, s, z, h).end();
      };
      const auto up = moved(unit), down = moved(-unit);
      const double scale = std::sqrt(norm(d.position[i])) + std::sqrt(norm(d.slope[i])) * std::abs(h);
      CHECK(std::abs((up.position.x - down.position.x) / (2.0 * unit) - d.position[i].x) < 1e-7 * scale);
      CHECK(std::abs((up.position.y - down.position.y) / (2.0 * unit) - d.position[i].y) < 1e-7 * scale);
      CHECK(std::abs((up.slope.x - down.slope.x) / (2.0 * unit) - d.slope[i].x) * std::abs(h) < 1e-7 * scale);
      CHECK(std::abs((up.slope.y - down.slope.y) / (2.0 * unit) - d.slope[i].y) * std::abs(h) < 1e-7 * scale);
    }
  };
  check(uniform_field{{0.1, -0.2, 0.9}}, 0.0, 30.0);
  check(graded, 200.0, -30.0);
  check(skew_field{}, 200.0, 30.0);
  check(layered_field{}, 200.0, 30.0);
  STATIC_REQUIRE(nystrom_step<double, graded_field>::columns == 5);
  STATIC_REQUIRE(nystrom_step<double, layered_field>::columns == 3);
}
