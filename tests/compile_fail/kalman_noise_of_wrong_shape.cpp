// SPDX-License-Identifier: MPL-2.0
// expect: the process noise's covariance must be a fixed-size N x N matrix
#include <scifi/kalman.hpp>

struct constant_velocity {
  scifi::matrix<double, 2, 2> transition(double dt) const { return (scifi::matrix<double, 2, 2>() << 1.0, dt, 0.0, 1.0).finished(); }
};

struct kicks {
  double covariance(double dt) const { return dt; }
};

int main() {
  const scifi::kalman::estimate start{scifi::vector<double, 2>(0.0, 0.0), scifi::matrix<double, 2, 2>(scifi::matrix<double, 2, 2>::Identity())};
  const auto end = scifi::kalman::filter{constant_velocity{}, kicks{}}.predict(start, 1.0);
  return end.status.ok() ? 0 : 1;
}
