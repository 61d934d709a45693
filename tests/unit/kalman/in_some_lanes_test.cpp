// SPDX-License-Identifier: MPL-2.0
#include <scifi/kalman/in_some_lanes.hpp>

#include <scifi/core/pack.hpp>
#include <scifi/kalman.hpp>

#include "support/catch.hpp"
#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

namespace {

using pack = scifi::pack<double, 2>;  // any processor has registers so wide

template <class Scalar>
struct position {
  Scalar z;
  Scalar value() const { return z; }
  double covariance() const { return 0.04; }
  scifi::matrix<double, 1, 2> projection() const { return {1.0, 0.0}; }
};

}  // namespace

TEST_CASE("a lane without the measurement keeps its estimate, the others take it in", "[kalman]") {
  const kalman::filter f{models::constant_velocity{}, kalman::no_noise{}};
  kalman::estimate<pack, 2> prior{scifi::vector<pack, 2>::Constant(pack(0.5)), scifi::matrix<pack, 2, 2>::Identity()};
  const kalman::estimate<double, 2> alone{scifi::vector<double, 2>::Constant(0.5), scifi::matrix<double, 2, 2>::Identity()};
  kalman::in_some_lanes<position<pack>, kalman::mask<pack>> m{{pack(0.0)}, true};
  for (int lane = 0; lane < pack::lanes; ++lane) m.z.set(lane, 0.1 * (lane + 1));
  constexpr int without = 1;
  m.where.set(without, false);
  const auto u = f.update(prior, m);
  REQUIRE(u.status.ok());
  for (int lane = 0; lane < pack::lanes; ++lane) {
    CHECK(u.outlier[lane] == (lane == without));
    const auto one = f.update(alone, position<double>{0.1 * (lane + 1)});
    const auto& expected = lane == without ? alone : one.posterior;
    for (int i = 0; i < 2; ++i) CHECK(u.posterior.mean(i)[lane] == Approx(expected.mean(i)).epsilon(1e-14));
    for (int i = 0; i < 4; ++i) CHECK(u.posterior.covariance.data()[i][lane] == Approx(expected.covariance.data()[i]).margin(1e-15));
  }
}

TEST_CASE("of a plain number the measurement is there or it is not", "[kalman]") {
  const kalman::filter f{models::constant_velocity{}, kalman::no_noise{}};
  const auto prior = kalman::uncorrelated(Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(1.0, 1.0));
  const kalman::in_some_lanes<position<double>, bool> there{{0.3}, true}, absent{{0.3}, false};
  CHECK(f.update(prior, there).posterior.mean == f.update(prior, position<double>{0.3}).posterior.mean);
  CHECK(f.update(prior, absent).posterior.mean == prior.mean);
  CHECK(f.update(prior, absent).outlier);
}
