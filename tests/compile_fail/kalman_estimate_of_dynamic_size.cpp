// SPDX-License-Identifier: MPL-2.0
// expect: an estimate needs a fixed-size Eigen mean and covariance
#include <scifi/kalman.hpp>


int main() {
  const Eigen::VectorXd mean = Eigen::VectorXd::Zero(2);
  const Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(2, 2);
  const scifi::kalman::estimate start{mean, covariance};
  return start.dimension;
}
