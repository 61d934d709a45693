// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include <cmath>
#include <limits>
#include <optional>
#include <variant>

#include <scifi/kalman/filter.hpp>

#include "laws/update_laws.hpp"
#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

namespace {

/// A random walk and its direct observation, for any scalar.
template <class Scalar>
struct walk {
  Scalar q;
  double transition(double) const { return 1.0; }
  Scalar covariance(double) const { return q; }
};
template <class Scalar>
struct reading {
  Scalar z, r;
  const Scalar& value() const { return z; }
  const Scalar& covariance() const { return r; }
  double projection() const { return 1.0; }
};

/// y = x^2.
struct squared {
  double z;
  double value() const { return z; }
  double covariance() const { return 1.0; }
  template <class Scalar>
  kalman::projected<Scalar, 1, 1> project(const scifi::vector<Scalar, 1>& x) const {
    return {scifi::vector<Scalar, 1>::Constant(x(0) * x(0)), scifi::matrix<Scalar, 1, 1>::Constant(Scalar(2.0) * x(0))};
  }
};

/// x' = x^2.
struct squaring {
  kalman::propagated<double, 1> propagate(const scifi::vector<double, 1>& x, double) const {
    return {scifi::vector<double, 1>::Constant(x(0) * x(0)), scifi::matrix<double, 1, 1>::Constant(2.0 * x(0))};
  }
};

scifi::vector<double, 1> one(double x) { return scifi::vector<double, 1>::Constant(x); }

/// Mean and variance after ten steps of a walk.
template <class Scalar>
kalman::estimate<Scalar, 1> ten_steps(const Scalar& q, const Scalar& r) {
  const kalman::filter f{walk<Scalar>{q}, walk<Scalar>{q}};
  kalman::estimate<Scalar, 1> e{scifi::vector<Scalar, 1>::Constant(Scalar(0.0)), scifi::matrix<Scalar, 1, 1>::Constant(Scalar(1.0))};
  for (int i = 0; i < 10; ++i) e = f.update(f.predict(e, 1.0), reading<Scalar>{Scalar(1.0 + 0.5 * (i % 3)), r}).posterior;
  return e;
}

}  // namespace

TEST_CASE("the gain of a random walk settles at the solution of the Riccati equation", "[kalman]") {
  for (const double q : {0.01, 1.0, 100.0}) {
    const double r = 2.0;
    const kalman::filter f{walk<double>{q}, walk<double>{q}};
    auto p = f.predict(kalman::uncorrelated(0.0, 3.0), 1.0);
    for (int i = 0; i < 2000; ++i) p = f.predict(f.update(p, reading<double>{0.0, r}), 1.0);
    // p = p r / (p + r) + q, so p^2 - q p - q r = 0.
    const double settled = 0.5 * (q + std::sqrt(q * q + 4.0 * q * r));
    CHECK(p.estimate.covariance(0, 0) == Approx(settled).epsilon(1e-13));
    const auto u = f.update(p, reading<double>{1.0, r});
    CHECK(u.posterior.mean(0) == Approx(settled / (settled + r)).epsilon(1e-13));
  }
}

TEST_CASE("a dual number carries the derivative of the fit by the noise", "[kalman]") {
  using dual = Eigen::AutoDiffScalar<Eigen::Vector2d>;
  const double q = 0.3, r = 0.7, h = 1e-5;
  const auto e = ten_steps(dual(q, 2, 0), dual(r, 2, 1));
  const auto plain = ten_steps(q, r);
  CHECK(e.mean(0).value() == Approx(plain.mean(0)).epsilon(1e-14));
  const auto slope = [h](const auto& up, const auto& down) { return (up - down) / (2.0 * h); };
  // Central differences: h^2 = 1e-10 of truncation, eps / h = 2e-11 of rounding.
  CHECK(e.mean(0).derivatives()(0) == Approx(slope(ten_steps(q + h, r).mean(0), ten_steps(q - h, r).mean(0))).epsilon(1e-7));
  CHECK(e.covariance(0, 0).derivatives()(1) == Approx(slope(ten_steps(q, r + h).covariance(0, 0), ten_steps(q, r - h).covariance(0, 0))).epsilon(1e-7));
}

TEST_CASE("float gives what double gives, to its precision", "[kalman]") {
  const auto narrow = ten_steps(0.3F, 0.7F);
  const auto wide = ten_steps(0.3, 0.7);
  CHECK(static_cast<double>(narrow.mean(0)) == Approx(wide.mean(0)).epsilon(1e-6));
  CHECK(static_cast<double>(narrow.covariance(0, 0)) == Approx(wide.covariance(0, 0)).epsilon(1e-6));
}

TEST_CASE("a model is linearised about the given state", "[kalman]") {
  const kalman::filter f{squaring{}, kalman::no_noise{}};
  const auto start = kalman::uncorrelated(2.0, 0.1);
  const auto p = f.predict(start, 1.0, one(3.0));
  CHECK(p.estimate.mean(0) == Approx(9.0 + 6.0 * (2.0 - 3.0)));
  CHECK(p.estimate.covariance(0, 0) == Approx(36.0 * 0.01));
  // h = 9 + 6 (x - 3) about 3: expected 3 at x = 2, S = 36 * 0.01 + 1.
  const auto u = f.update(start, squared{4.0}, one(3.0));
  CHECK(u.residual(0) == Approx(1.0));
  CHECK(u.residual_covariance(0, 0) == Approx(1.36));
  CHECK(u.posterior.mean(0) == Approx(2.0 + 0.06 / 1.36));
  CHECK(f.predict(start, 1.0, start.mean).estimate.mean == f.predict(start, 1.0).estimate.mean);
}

TEST_CASE("an empty step and no measurement change nothing", "[kalman]") {
  const kalman::filter f{models::constant_velocity{}, models::white_acceleration{1.0}};
  const auto e = kalman::uncorrelated(Eigen::Vector2d(1.0, 2.0), Eigen::Vector2d(3.0, 4.0));
  const auto p = f.predict(e, std::optional<double>{});
  CHECK(p.estimate.covariance == e.covariance);
  CHECK(p.jacobian.isIdentity(0.0));
  const auto u = f.update(p, kalman::no_measurement{});
  CHECK(u.posterior.mean == e.mean);
  CHECK(u.chi2 == 0.0);
  CHECK(u.measurement_dimension() == 0);
  CHECK(u.status == kalman::status{kalman::step_kind::update, kalman::reason::none});
}

TEST_CASE("an update by a variant or an optional is the update by what it holds", "[kalman]") {
  using point = models::linear_values<2, 2>;
  const kalman::filter f{models::constant_velocity{}, models::white_acceleration{1.0}};
  const auto e = kalman::uncorrelated(Eigen::Vector2d(1.0, 2.0), Eigen::Vector2d(3.0, 4.0));
  const point two{{1.0, 1.0}, Eigen::Matrix2d::Identity(), Eigen::Matrix2d::Identity()};
  const auto direct = f.update(e, two);
  const auto through = f.update(e, std::variant<models::position, point>(two));
  CHECK(through.posterior.covariance == direct.posterior.covariance);
  CHECK(through.measurement_dimension() == 2);
  CHECK(through.chi2 == direct.chi2);
  const auto about = f.update(e, std::variant<models::position, point>(two), e.mean);
  CHECK(laws::estimate_distance(about.posterior, direct.posterior) < 1e-14);
  CHECK(f.update(e, std::optional<point>{}).measurement_dimension() == 0);
}

TEST_CASE("a failed step keeps the estimate, names the step and the reason and is passed on untouched", "[kalman]") {
  constexpr double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const kalman::filter f{models::constant_velocity{}, models::white_acceleration{1.0}};
  const auto e = kalman::uncorrelated(Eigen::Vector2d(1.0, 2.0), Eigen::Vector2d(3.0, 4.0));

  const auto p = f.predict(e, inf);
  CHECK(p.status == kalman::status{kalman::step_kind::predict, kalman::reason::not_finite});
  CHECK(p.estimate.mean == e.mean);
  CHECK(p.estimate.covariance == e.covariance);
  const auto later = f.update(f.predict(f.update(p, models::position{1.0, 1.0}), 1.0), std::variant<models::position>(models::position{1.0, 1.0}));
  CHECK(later.status == p.status);
  CHECK(later.posterior.mean == e.mean);
  CHECK(later.chi2 == 0.0);

  const auto u = f.update(e, models::position{nan, 1.0});
  CHECK(u.status == kalman::status{kalman::step_kind::update, kalman::reason::not_finite});
  CHECK(u.posterior.mean == e.mean);

  const kalman::filter shrinking{models::constant_velocity{}, models::white_acceleration{-100.0}};
  CHECK(shrinking.predict(e, 5.0).status == kalman::status{kalman::step_kind::predict, kalman::reason::not_positive_definite});

  const auto known = kalman::uncorrelated(Eigen::Vector2d(1.0, 2.0), Eigen::Vector2d(0.0, 4.0));
  CHECK(f.update(known, models::position{1.0, 0.0}).status == kalman::status{kalman::step_kind::update, kalman::reason::singular_innovation});
}

TEST_CASE("a gate that rejects leaves the estimate and marks the outlier", "[kalman]") {
  const kalman::filter f{models::constant_velocity{}, models::white_acceleration{1.0}, kalman::joseph{}, kalman::chi2_gate{9.0}};
  const auto e = kalman::uncorrelated(Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.6, 1.0));
  CHECK_FALSE(f.update(e, models::position{2.9, 0.8}).outlier);  // S = 1
  const auto u = f.update(e, models::position{3.1, 0.8});
  CHECK(u.outlier);
  CHECK(u.posterior.covariance == e.covariance);
  CHECK(u.chi2 == Approx(9.61));
}
