// SPDX-License-Identifier: MPL-2.0
#include "support/catch.hpp"

#include <scifi/kalman/process_noise.hpp>

#include "laws/process_noise_laws.hpp"
#include "unit/kalman/models.hpp"

namespace kalman = scifi::kalman;

namespace {

struct of_step {
  double covariance(double step) const { return step; }
};
struct of_start {
  double covariance(const scifi::vector<double, 1>& start, double step) const { return step * start(0); }
};
struct of_all {
  double covariance(double step) const { return step; }
  double covariance(const scifi::vector<double, 1>&, double step, const kalman::propagated<double, 1>& moved) const { return step * moved.jacobian(0, 0); }
};

template <class Q>
double noise(const Q& q) {
  const scifi::vector<double, 1> start = scifi::vector<double, 1>::Constant(5.0);
  const kalman::propagated<double, 1> moved{start, scifi::matrix<double, 1, 1>::Constant(7.0)};
  return kalman::detail::noise_covariance<double, 1>(q, start, 2.0, moved)(0, 0);
}

}  // namespace

TEST_CASE("process noise is asked with as many arguments as it takes", "[kalman]") {
  CHECK(noise(of_step{}) == 2.0);
  CHECK(noise(of_start{}) == 10.0);
  CHECK(noise(of_all{}) == 14.0);
  CHECK(noise(kalman::no_noise{}) == 0.0);
}

TEST_CASE("white acceleration obeys the laws of a process noise in both directions", "[kalman]") {
  const scifi::vector<double, 2> x(1.0, 2.0);
  for (const double dt : {-3.0, -0.1, 0.1, 3.0}) CHECK(laws::smallest_noise_eigenvalue(models::white_acceleration{2.0}, models::constant_velocity{}, x, dt) >= 0.0);
  CHECK(laws::noise_norm(models::white_acceleration{2.0}, models::constant_velocity{}, x, 0.0) == 0.0);
}
