// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <utility>

#include <scifi/core/scalar.hpp>
#include <scifi/kalman/estimate.hpp>
#include <scifi/kalman/shape.hpp>
#include <scifi/kalman/status.hpp>

namespace scifi::kalman {

/// What a comparison of two scalars yields: bool, or a mask with one entry a lane.
template <class Scalar>
using mask = decltype(std::declval<const Scalar&>() < std::declval<const Scalar&>());

/// Result of a prediction: the estimate after the step, the Jacobian of the step (d end / d start) and the noise it added.
/// When the status is not ok the estimate is the one before the step.
template <class Estimate>
struct basic_predicted {
  using scalar = typename Estimate::scalar;
  static constexpr int dimension = Estimate::dimension;

  Estimate estimate;
  matrix<scalar, dimension, dimension> jacobian;
  matrix<scalar, dimension, dimension> noise;
  kalman::status status{step_kind::predict, reason::none};
};

/// `basic_predicted` of a mean and a covariance.
template <class Scalar, int N>
using predicted = basic_predicted<estimate<Scalar, N>>;

/// Result of an update. M is the measurement's dimension; Eigen::Dynamic up to MaxM where it is known only at run time.
/// When the status is not ok, or the measurement is an outlier, the posterior is the estimate before the update.
template <class Estimate, int M, int MaxM = M>
struct basic_updated {
  using scalar = typename Estimate::scalar;
  static constexpr int dimension = Estimate::dimension;

  Estimate posterior;
  /// Measured minus expected from the state before the update.
  bounded_matrix<scalar, M, 1, MaxM, 1> residual;
  /// S = H P H' + R, P before the update.
  bounded_matrix<scalar, M, M, MaxM, MaxM> residual_covariance;
  /// H, derivative of the expected measurement by the state.
  bounded_matrix<scalar, M, dimension, MaxM, dimension> jacobian;
  /// R, covariance of the measurement.
  bounded_matrix<scalar, M, M, MaxM, MaxM> measurement_covariance;
  /// residual' S^-1 residual; follows chi-squared with M degrees of freedom.
  scalar chi2{0.0};
  kalman::status status{step_kind::update, reason::none};
  /// True where the gate rejected the measurement.
  mask<scalar> outlier{};

  /// Dimension of the measurement, 0 where there was none.
  [[nodiscard]] int measurement_dimension() const { return static_cast<int>(residual.size()); }
};

/// `basic_updated` of a mean and a covariance.
template <class Scalar, int N, int M>
using updated = basic_updated<estimate<Scalar, N>, M>;

/// `updated` by a measurement whose dimension, at most MaxM, is known only at run time.
template <class Scalar, int N, int MaxM>
using mixed_updated = basic_updated<estimate<Scalar, N>, Eigen::Dynamic, MaxM>;

namespace detail {

template <class E>
concept plain_estimate = requires(const E& e) {
  typename E::scalar;
  E::dimension;
  e.mean;
};

/// An estimate that stands elsewhere, with the status of the step that made it.
template <class E>
struct basic_prior {
  const E& estimate;
  kalman::status status;
};

template <plain_estimate E>
[[nodiscard]] const E& estimate_in(const E& e) { return e; }
template <class E>
[[nodiscard]] const E& estimate_in(const basic_predicted<E>& p) { return p.estimate; }
template <class E, int M, int MaxM>
[[nodiscard]] const E& estimate_in(const basic_updated<E, M, MaxM>& u) { return u.posterior; }

template <class E>
[[nodiscard]] const E& estimate_in(const basic_prior<E>& p) { return p.estimate; }

template <plain_estimate E>
[[nodiscard]] constexpr status status_in(const E&) { return {}; }
template <class E>
[[nodiscard]] constexpr status status_in(const basic_predicted<E>& p) { return p.status; }
template <class E>
[[nodiscard]] constexpr status status_in(const basic_prior<E>& p) { return p.status; }
template <class E, int M, int MaxM>
[[nodiscard]] constexpr status status_in(const basic_updated<E, M, MaxM>& u) { return u.status; }

/// An estimate, or the result of a step that holds one.
template <class T>
concept prior = requires(const T& t) { estimate_in(t); };

template <prior T>
using estimate_type = std::remove_cvref_t<decltype(estimate_in(std::declval<const T&>()))>;

}  // namespace detail

}  // namespace scifi::kalman
