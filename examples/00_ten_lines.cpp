// SPDX-License-Identifier: MPL-2.0
// A filter in ten lines: a cart on a rail whose position is read ten times; no physics of this library is involved.

#include <cmath>
#include <cstdio>

#include <scifi/kalman.hpp>

// [ten_lines]
namespace kalman = scifi::kalman;

struct cart {  // position, speed
  scifi::matrix<double, 2, 2> transition(double dt) const { return scifi::matrix<double, 2, 2>{{1.0, dt}, {0.0, 1.0}}; }
};
struct ruler {
  double reading;
  double value() const { return reading; }
  double covariance() const { return 0.01; }
  scifi::matrix<double, 1, 2> projection() const { return {1.0, 0.0}; }
};

double speed_of_cart(double true_speed) {
  const kalman::filter f{cart{}, kalman::no_noise{}};
  auto now = kalman::uncorrelated(scifi::vector<double, 2>(0.0, 0.0), scifi::vector<double, 2>(100.0, 100.0));
  for (int i = 1; i <= 10; ++i) now = f.update(f.predict(now, 0.1), ruler{0.1 * i * true_speed}).posterior;
  return now.mean[1];
}
// [ten_lines]

int main() {
  const double speed = speed_of_cart(3.0);
  std::printf("speed %.4f, true 3\n", speed);
  // The prior of (0 +- 100) pulls the speed by less than (sigma of the fit / 100)^2 of it: 10 points over 0.9 s with 0.1 give sigma 0.11.
  return std::abs(speed - 3.0) < 3.0 * 2.0 * (0.11 / 100.0) * (0.11 / 100.0) ? 0 : 1;
}
