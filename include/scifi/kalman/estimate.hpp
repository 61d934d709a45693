// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <limits>
#include <type_traits>

#include <scifi/core/linalg.hpp>
#include <scifi/core/scalar.hpp>
#include <scifi/kalman/shape.hpp>

namespace scifi::kalman {

/// What is known of a state: its mean (N) and its covariance (N x N, symmetric, positive semidefinite), in the units of the state.
template <class Scalar, int N>
struct estimate {
  static_assert(N > 0, "scifi: an estimate needs a fixed-size Eigen mean and covariance; a dynamic size is not accepted");
  static_assert(!std::is_integral_v<Scalar>, "scifi: an estimate cannot be of whole numbers; write 20.0 for 20");
  using scalar = Scalar;
  static constexpr int dimension = N;

  vector<Scalar, N> mean;
  matrix<Scalar, N, N> covariance;
};

namespace detail {

template <class Mean, class Covariance>
struct estimate_deduction {
  static constexpr int rows = Mean::RowsAtCompileTime;
  static constexpr bool fixed = rows > 0 && Covariance::RowsAtCompileTime > 0 && Covariance::ColsAtCompileTime > 0;
  static_assert(fixed, "scifi: an estimate needs a fixed-size Eigen mean and covariance; a dynamic size is not accepted");
  static_assert(!fixed || Mean::ColsAtCompileTime == 1, "scifi: the mean of an estimate must be a column vector");
  static_assert(!fixed || (Covariance::RowsAtCompileTime == rows && Covariance::ColsAtCompileTime == rows),
                "scifi: the covariance of an estimate must be N x N, where N is the size of its mean");
  static constexpr int dimension = fixed ? rows : 1;
};

}  // namespace detail

template <class Mean, class Covariance>
estimate(const Eigen::MatrixBase<Mean>&, const Eigen::MatrixBase<Covariance>&)
    -> estimate<typename Mean::Scalar, detail::estimate_deduction<Mean, Covariance>::dimension>;

/// An estimate of N uncorrelated components from their means and standard deviations.
template <class Mean, class Sigmas>
[[nodiscard]] auto uncorrelated(const Eigen::MatrixBase<Mean>& mean, const Eigen::MatrixBase<Sigmas>& sigmas) {
  using Scalar = typename Mean::Scalar;
  constexpr int N = Mean::RowsAtCompileTime;
  static_assert(detail::shaped<Mean, N, 1> && detail::shaped<Sigmas, N, 1>,
                "scifi: uncorrelated needs two fixed-size column vectors of the same length");
  estimate<Scalar, N> out{mean, matrix<Scalar, N, N>::Zero()};
  for (int i = 0; i < N; ++i) out.covariance(i, i) = square<Scalar>(sigmas(i));
  return out;
}

/// A one-dimensional estimate from its mean and standard deviation.
template <scalar Scalar>
  requires(!detail::eigen_like<Scalar> && !std::is_integral_v<Scalar>)
[[nodiscard]] estimate<Scalar, 1> uncorrelated(const Scalar& mean, const Scalar& sigma) {
  return {vector<Scalar, 1>::Constant(mean), matrix<Scalar, 1, 1>::Constant(square<Scalar>(sigma))};
}

/// The same from two plain numbers of different types, of which a whole one counts as double: uncorrelated(20, 0.5).
template <class Mean, class Sigma>
  requires(std::is_arithmetic_v<Mean> && std::is_arithmetic_v<Sigma> && (!std::is_same_v<Mean, Sigma> || std::is_integral_v<Mean>))
[[nodiscard]] auto uncorrelated(Mean mean, Sigma sigma) {
  using real = std::conditional_t<std::is_integral_v<Mean> || std::is_integral_v<Sigma>, double, std::common_type_t<Mean, Sigma>>;
  return uncorrelated(static_cast<real>(mean), static_cast<real>(sigma));
}

/// Standard deviation from a variance; NaN where the variance is negative.
template <scalar Scalar>
[[nodiscard]] Scalar sigma_of_variance(const Scalar& variance) {
  using std::sqrt;
  const auto negative = variance < Scalar(0.0);
  const Scalar safe = select(negative, Scalar(1.0), variance);
  const Scalar root = sqrt(safe);
  return select(negative, Scalar(std::numeric_limits<double>::quiet_NaN()), root);
}

/// Standard deviation of one component, in the unit of that component; NaN where its variance is negative.
template <class Scalar, int N, class Component>
[[nodiscard]] Scalar sigma(const estimate<Scalar, N>& e, Component component) {
  const int i = static_cast<int>(component);
  return sigma_of_variance<Scalar>(e.covariance(i, i));
}

}  // namespace scifi::kalman
