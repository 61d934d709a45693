// SPDX-License-Identifier: MPL-2.0
// expect: the process noise has no const covariance(step), covariance(start, step) or covariance(start, step, moved)
#include <scifi/kalman.hpp>

struct constant_velocity {
  scifi::matrix<double, 2, 2> transition(double dt) const { return (scifi::matrix<double, 2, 2>() << 1.0, dt, 0.0, 1.0).finished(); }
};

struct kicks {
  double strength = 1.0;
};

int main() {
  const scifi::kalman::estimate start{scifi::vector<double, 2>(0.0, 0.0), scifi::matrix<double, 2, 2>(scifi::matrix<double, 2, 2>::Identity())};
  const auto end = scifi::kalman::filter{constant_velocity{}, kicks{}}.predict(start, 1.0);
  return end.status.ok() ? 0 : 1;
}
