// SPDX-License-Identifier: MPL-2.0
// expect: the covariance of an estimate must be N x N
#include <scifi/kalman.hpp>


int main() {
  const scifi::vector<double, 2> mean(0.0, 0.0);
  const scifi::matrix<double, 3, 3> covariance = scifi::matrix<double, 3, 3>::Identity();
  const scifi::kalman::estimate start{mean, covariance};
  return start.dimension;
}
