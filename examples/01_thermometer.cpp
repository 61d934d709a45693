// SPDX-License-Identifier: MPL-2.0
// A room drifts in temperature and a thermometer reads it: a state of one number, the smallest filter there is.

#include <cmath>
#include <cstdio>

#include <scifi/kalman.hpp>

namespace kalman = scifi::kalman;

// [model]
struct room {  // degrees Celsius; a step is a time in minutes
  double transition(double) const { return 1.0; }
};
struct drift {
  double per_minute;  // variance
  double covariance(double minutes) const { return per_minute * minutes; }
};
struct thermometer {
  double reading, sigma = 0.5;
  double value() const { return reading; }
  double covariance() const { return sigma * sigma; }
  double projection() const { return 1.0; }
};
// [model]

int main() {
  // [filter]
  const kalman::filter f{room{}, drift{0.01}};
  auto now = f.update(kalman::uncorrelated(20.0, 5.0), thermometer{21.3});
  for (const double reading : {21.0, 21.6, 21.2, 21.9, 21.5}) now = f.update(f.predict(now, 1.0), thermometer{reading});
  // [filter]
  std::printf("%.3f +- %.3f degrees, %s\n", now.posterior.mean(0), kalman::sigma(now.posterior, 0), kalman::describe(now.status.why).data());
  if (!now.status.ok()) return 1;

  // After many steps the variance v satisfies 1/v = 1/(v + q) + 1/r: v = (sqrt(q^2 + 4 q r) - q) / 2.
  for (int minute = 0; minute < 200; ++minute) now = f.update(f.predict(now, 1.0), thermometer{21.5});
  const double q = 0.01, r = 0.25, settled = 0.5 * (std::sqrt(q * q + 4.0 * q * r) - q);
  std::printf("variance %.12f, in closed form %.12f\n", now.posterior.covariance(0, 0), settled);
  const bool right = std::abs(now.posterior.covariance(0, 0) - settled) < 1e-12 && std::abs(now.posterior.mean(0) - 21.5) < 1e-6;
  return right ? 0 : 1;
}
