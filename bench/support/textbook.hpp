// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/LU>

// The Kalman filter as a textbook writes it, on Eigen matrices of any kind: what the library's timings are compared with.
namespace textbook {

template <class Mean, class Covariance>
struct knowledge {
  Mean x;
  Covariance p;
};

/// One predict and update, P+ = (I - K H) P.
template <class Mean, class Covariance, class F, class Q, class H, class R, class Z>
void plain_step(knowledge<Mean, Covariance>& e, const F& f, const Q& q, const H& h, const R& r, const Z& z) {
  e.x = f * e.x;
  e.p = f * e.p * f.transpose() + q;
  const R s = h * e.p * h.transpose() + r;
  const Eigen::Matrix<typename Mean::Scalar, H::ColsAtCompileTime, H::RowsAtCompileTime> k = e.p * h.transpose() * s.inverse();
  e.x = e.x + k * (z - h * e.x);
  e.p = (Covariance::Identity(e.p.rows(), e.p.cols()) - k * h) * e.p;
}

/// The same in Joseph's form, P+ = (I - K H) P (I - K H)' + K R K'.
template <class Mean, class Covariance, class F, class Q, class H, class R, class Z>
void joseph_step(knowledge<Mean, Covariance>& e, const F& f, const Q& q, const H& h, const R& r, const Z& z) {
  e.x = f * e.x;
  e.p = f * e.p * f.transpose() + q;
  const R s = h * e.p * h.transpose() + r;
  const Eigen::Matrix<typename Mean::Scalar, H::ColsAtCompileTime, H::RowsAtCompileTime> k = e.p * h.transpose() * s.inverse();
  e.x = e.x + k * (z - h * e.x);
  const Covariance a = Covariance::Identity(e.p.rows(), e.p.cols()) - k * h;
  e.p = a * e.p * a.transpose() + k * r * k.transpose();
}

}  // namespace textbook
