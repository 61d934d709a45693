// SPDX-License-Identifier: MPL-2.0
// expect: the measurement has no const value()
#include <scifi/kalman.hpp>

struct constant_velocity {
  scifi::matrix<double, 2, 2> transition(double dt) const { return (scifi::matrix<double, 2, 2>() << 1.0, dt, 0.0, 1.0).finished(); }
};

struct position {
  double covariance() const { return 0.01; }
  scifi::matrix<double, 1, 2> projection() const { return {1.0, 0.0}; }
};

int main() {
  const scifi::kalman::estimate start{scifi::vector<double, 2>(0.0, 0.0), scifi::matrix<double, 2, 2>(scifi::matrix<double, 2, 2>::Identity())};
  const auto after = scifi::kalman::filter{constant_velocity{}, scifi::kalman::no_noise{}}.update(start, position{});
  return after.status.ok() ? 0 : 1;
}
