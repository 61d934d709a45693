// SPDX-License-Identifier: MPL-2.0
// expect: the propagator has neither a const transition(step) nor a const propagate(x, step)
#include <scifi/kalman.hpp>

struct motion {
  double velocity = 1.0;
};

int main() {
  const scifi::kalman::estimate start{scifi::vector<double, 2>(0.0, 0.0), scifi::matrix<double, 2, 2>(scifi::matrix<double, 2, 2>::Identity())};
  const auto end = scifi::kalman::filter{motion{}, scifi::kalman::no_noise{}}.predict(start, 1.0);
  return end.status.ok() ? 0 : 1;
}
