// SPDX-License-Identifier: MPL-2.0
// expect: the nodes of a run have no room for a measurement of this dimension
#include <array>

#include <scifi/kalman.hpp>

struct constant_velocity {
  scifi::matrix<double, 2, 2> transition(double dt) const { return (scifi::matrix<double, 2, 2>() << 1.0, dt, 0.0, 1.0).finished(); }
};

struct point {
  scifi::vector<double, 2> value() const { return {0.0, 0.0}; }
  scifi::matrix<double, 2, 2> covariance() const { return scifi::matrix<double, 2, 2>::Identity(); }
  scifi::matrix<double, 2, 2> projection() const { return scifi::matrix<double, 2, 2>::Identity(); }
};

int main() {
  const scifi::kalman::estimate start{scifi::vector<double, 2>(0.0, 0.0), scifi::matrix<double, 2, 2>(scifi::matrix<double, 2, 2>::Identity())};
  const std::array sites{scifi::kalman::site{1.0, point{}}};
  std::array<scifi::kalman::node<double, 2, 1>, 1> nodes;
  const auto result = scifi::kalman::filter{constant_velocity{}, scifi::kalman::no_noise{}}.run(start, sites, nodes);
  return result.status.ok() ? 0 : 1;
}
