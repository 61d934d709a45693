// SPDX-License-Identifier: MPL-2.0
// expect: the propagator's Jacobian must be N x N
#include <scifi/kalman.hpp>

struct arrival {
  scifi::vector<double, 2> state;
  scifi::matrix<double, 2, 3> jacobian;
};

struct motion {
  arrival propagate(const scifi::vector<double, 2>& x, double) const { return {x, scifi::matrix<double, 2, 3>::Zero()}; }
};

int main() {
  const scifi::kalman::estimate start{scifi::vector<double, 2>(0.0, 0.0), scifi::matrix<double, 2, 2>(scifi::matrix<double, 2, 2>::Identity())};
  const auto end = scifi::kalman::filter{motion{}, scifi::kalman::no_noise{}}.predict(start, 1.0);
  return end.status.ok() ? 0 : 1;
}
