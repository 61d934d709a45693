// SPDX-License-Identifier: MPL-2.0
// expect: predict, update and run need an estimate
#include <scifi/kalman.hpp>

struct constant_velocity {
  scifi::matrix<double, 2, 2> transition(double dt) const { return (scifi::matrix<double, 2, 2>() << 1.0, dt, 0.0, 1.0).finished(); }
};

int main() {
  const scifi::vector<double, 2> start(0.0, 0.0);
  const auto end = scifi::kalman::filter{constant_velocity{}, scifi::kalman::no_noise{}}.predict(start, 1.0);
  return end.status.ok() ? 0 : 1;
}
