// SPDX-License-Identifier: MPL-2.0
// expect: the propagator and the process noise declare different state spaces
#include <scifi/kalman.hpp>

struct slopes {};
struct momenta {};

struct constant_velocity {
  using state_space = slopes;
  scifi::matrix<double, 2, 2> transition(double dt) const { return (scifi::matrix<double, 2, 2>() << 1.0, dt, 0.0, 1.0).finished(); }
};

struct kicks {
  using state_space = momenta;
  scifi::matrix<double, 2, 2> covariance(double) const { return scifi::matrix<double, 2, 2>::Identity(); }
};

int main() {
  const scifi::kalman::estimate start{scifi::vector<double, 2>(0.0, 0.0), scifi::matrix<double, 2, 2>(scifi::matrix<double, 2, 2>::Identity())};
  const auto end = scifi::kalman::filter{constant_velocity{}, kicks{}}.predict(start, 1.0);
  return end.status.ok() ? 0 : 1;
}
