// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/Cholesky>

#include <limits>

#include <scifi/kalman/filter.hpp>

// A measurement far more precise than what is known before it, at every step: the ratio of variances is about 1/eps^1.25.
// 1 - K then rounds to nothing and (I - K H) P loses the variance that is left.
namespace ill_conditioned {

/// Position, velocity, acceleration, with a large kick to the position at every step.
template <class Scalar>
struct chain {
  scifi::matrix<Scalar, 3, 3> transition(Scalar dt) const {
    scifi::matrix<Scalar, 3, 3> f = scifi::matrix<Scalar, 3, 3>::Identity();
    f(0, 1) = f(1, 2) = dt;
    f(0, 2) = Scalar(0.5) * dt * dt;
    return f;
  }
};

template <class Scalar>
struct kicks {
  Scalar position_variance;
  scifi::matrix<Scalar, 3, 3> covariance(Scalar) const {
    return scifi::vector<Scalar, 3>(position_variance, Scalar(1e-2), Scalar(1e-2)).asDiagonal().toDenseMatrix();
  }
};

template <class Scalar>
struct position {
  Scalar z, variance;
  Scalar value() const { return z; }
  Scalar covariance() const { return variance; }
  scifi::matrix<Scalar, 1, 3> projection() const { return {Scalar(1), Scalar(0), Scalar(0)}; }
};

struct findings {
  long failed = 0, not_symmetric = 0, not_positive_definite = 0;
  Eigen::Matrix3d last = Eigen::Matrix3d::Zero();
};

/// Runs predict and update `steps` times and counts what is wrong with the covariance after each.
template <class Scalar, class Update, bool Factored = false>
findings drive(const Update& update, long steps) {
  using std::pow;
  const Scalar ratio = pow(std::numeric_limits<Scalar>::epsilon(), Scalar(-1.25));
  const Scalar variance = Scalar(1e-4);
  const scifi::kalman::filter filter{chain<Scalar>{}, kicks<Scalar>{variance * ratio}, update};
  scifi::kalman::estimate<Scalar, 3> start{scifi::vector<Scalar, 3>::Zero(), scifi::matrix<Scalar, 3, 3>::Identity()};
  auto current = [&] {
    if constexpr (Factored) return scifi::kalman::factored(start);
    else return start;
  }();
  findings found;
  for (long i = 0; i < steps; ++i) {
    const auto after = filter.update(filter.predict(current, Scalar(1)), position<Scalar>{Scalar(i % 7), variance});
    if (!after.status.ok()) {
      ++found.failed;
      current.mean.setZero();
      continue;
    }
    current = after.posterior;
    const scifi::matrix<Scalar, 3, 3> covariance = scifi::kalman::unfactored(current).covariance;
    if (covariance != covariance.transpose()) ++found.not_symmetric;
    if (Eigen::LLT<scifi::matrix<Scalar, 3, 3>>(covariance).info() != Eigen::Success) ++found.not_positive_definite;
    found.last = covariance.template cast<double>();
  }
  return found;
}

}  // namespace ill_conditioned
