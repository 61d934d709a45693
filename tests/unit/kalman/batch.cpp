// SPDX-License-Identifier: MPL-2.0
#include "unit/kalman/batch.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>

namespace models {

void batch::add(int first, const Eigen::MatrixXd& a, const Eigen::VectorXd& b, const Eigen::MatrixXd& c) {
  const Eigen::MatrixXd l = c.llt().matrixL();
  const Eigen::MatrixXd wa = l.triangularView<Eigen::Lower>().solve(a);
  const Eigen::VectorXd wb = l.triangularView<Eigen::Lower>().solve(b);
  const Eigen::Index old = a_.rows();
  a_.conservativeResize(old + a.rows(), columns_);
  b_.conservativeResize(old + a.rows());
  a_.bottomRows(a.rows()).setZero();
  a_.block(old, first * n_, a.rows(), a.cols()) = wa;
  b_.tail(a.rows()) = wb;
}

void batch::solve() {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(a_);
  x_ = qr.solve(b_);
  chi2_ = (a_ * x_ - b_).squaredNorm();
  const Eigen::MatrixXd r = Eigen::HouseholderQR<Eigen::MatrixXd>(a_).matrixQR().topRows(columns_).triangularView<Eigen::Upper>();
  const Eigen::MatrixXd inverse = r.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(columns_, columns_));
  covariance_ = inverse * inverse.transpose();
}

}  // namespace models
