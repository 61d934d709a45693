// SPDX-License-Identifier: MPL-2.0
// expect: scifi: the measurement of automatic_projection needs a const expected(x), a template that takes a state of any scalar
#include <scifi/kalman/automatic_jacobian.hpp>

struct reading {
  double value() const { return 1.0; }
  double covariance() const { return 0.01; }
  double expected(const scifi::vector<double, 2>& x) const { return x[0] * x[0]; }
};

int main() { return scifi::kalman::automatic_projection{reading{}}.project(scifi::vector<double, 2>(0.0, 1.0)).value[0] > 0.0 ? 0 : 1; }
