// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/Core>

namespace models {

/// Weighted least squares over all states at once: rows are whitened and stacked, then solved by Eigen's QR.
/// Unknowns are `states` vectors of n components, one after the other.
class batch {
 public:
  batch(int states, int n) : n_(n), columns_(states * n) {}

  /// Adds rows a x = b with covariance c, where a acts on the states from index `first` on.
  void add(int first, const Eigen::MatrixXd& a, const Eigen::VectorXd& b, const Eigen::MatrixXd& c);

  void solve();

  Eigen::VectorXd mean(int state) const { return x_.segment(state * n_, n_); }
  Eigen::MatrixXd covariance(int state) const { return covariance_.block(state * n_, state * n_, n_, n_); }
  double chi2() const { return chi2_; }

 private:
  int n_, columns_;
  Eigen::MatrixXd a_, covariance_;
  Eigen::VectorXd b_, x_;
  double chi2_ = 0.0;
};

}  // namespace models
