// SPDX-License-Identifier: MPL-2.0
// expect: scifi: the function of automatic_jacobian must be a template that takes a vector of any scalar
#include <scifi/kalman/automatic_jacobian.hpp>

int main() {
  const auto drift = [](const scifi::vector<double, 2>& x, double dt) { return scifi::vector<double, 2>(x[0] + dt * x[1], x[1]); };
  return scifi::kalman::automatic_jacobian{drift}.propagate(scifi::vector<double, 2>(0.0, 1.0), 1.0).state[0] > 0.0 ? 0 : 1;
}
