// SPDX-License-Identifier: MPL-2.0
// expect: scifi: predict, update and run need an estimate
#include <array>

#include <scifi/kalman/filter.hpp>
#include <scifi/kalman/site.hpp>

struct room {
  double transition(double) const { return 1.0; }
};
struct thermometer {
  double value() const { return 20.0; }
  double covariance() const { return 0.25; }
  double projection() const { return 1.0; }
};

int main() {
  const std::array<scifi::kalman::site<double, thermometer>, 2> sites{};
  std::array<scifi::kalman::node<double, 1, 1>, 2> nodes;
  return scifi::kalman::filter{room{}, scifi::kalman::no_noise{}}.run(20.0, sites, nodes).status.ok() ? 0 : 1;
}
