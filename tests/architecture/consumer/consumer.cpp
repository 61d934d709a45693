// SPDX-License-Identifier: MPL-2.0
#include <scifi/kalman.hpp>
#include <scifi/track_model/helix_propagator.hpp>
#include <scifi/version.hpp>

#include <cstdio>

#if SCIFI_VERSION < 100
#error "older than 0.1.0"
#endif

struct constant_level {
  scifi::matrix<double, 1, 1> transition() const { return scifi::matrix<double, 1, 1>{1.0}; }
};
struct reading {
  double measured;
  double value() const { return measured; }
  double covariance() const { return 1.0; }
  scifi::matrix<double, 1, 1> projection() const { return scifi::matrix<double, 1, 1>{1.0}; }
};

int main() {
  namespace kalman = scifi::kalman;
  const kalman::filter f{constant_level{}, kalman::no_noise{}};
  auto level = kalman::uncorrelated(scifi::vector<double, 1>(0.0), scifi::vector<double, 1>(1e6));
  for (const double measured : {1.0, 2.0, 3.0}) level = f.update(level, reading{measured}).posterior;
  std::printf("scifi %s\n", scifi::version.data());
  return level.mean[0] > 1.99 && level.mean[0] < 2.01 ? 0 : 1;  // their mean
}
