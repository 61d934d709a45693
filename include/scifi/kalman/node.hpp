// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <type_traits>

#include <scifi/kalman/updated.hpp>

namespace scifi::kalman {

/// What a run leaves at one site. MaxM is the largest dimension of a measurement; nothing is on the heap.
template <class Scalar, int N, int MaxM>
struct node {
  static_assert(MaxM > 0, "scifi: a node needs room for measurements of at least one dimension");
  using scalar = Scalar;
  static constexpr int dimension = N;
  static constexpr int max_measurement_dimension = MaxM;

  /// Before this site's measurement, after it, and with all sites; the last is set by `smooth`.
  estimate<Scalar, N> predicted, filtered, smoothed;
  /// Derivative of this site's state by that of the site before (or of the start), and the noise added on the way.
  matrix<Scalar, N, N> jacobian, noise;
  /// Measured minus expected from the predicted state, and its covariance S.
  bounded_matrix<Scalar, Eigen::Dynamic, 1, MaxM, 1> residual;
  bounded_matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, MaxM, MaxM> residual_covariance;
  /// H and R of the measurement.
  bounded_matrix<Scalar, Eigen::Dynamic, N, MaxM, N> projection;
  bounded_matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, MaxM, MaxM> measurement_covariance;
  /// Of the predicted residual, also where the gate rejected the measurement.
  Scalar chi2{0.0};
  /// 0 where nothing was measured.
  int measurement_dimension = 0;
  mask<Scalar> outlier{};
  /// Not ok until a run has filled the node.
  kalman::status status{step_kind::predict, reason::not_reached};
};

/// A number of degrees of freedom: an int, or a number a lane where the scalar is a pack.
template <class Scalar>
using count = std::conditional_t<std::is_same_v<mask<Scalar>, bool>, int, Scalar>;

/// `failed_at` of a run that did not fail.
inline constexpr std::size_t no_failure = static_cast<std::size_t>(-1);

/// Outcome of a run. Nodes [0, reached) are complete also when a later step failed.
template <class Scalar>
struct run_result {
  std::size_t reached = 0;
  /// Sum over the measurements that were used.
  Scalar chi2{0.0};
  /// Number of values measured and used; the start estimate counts as knowledge and takes none away.
  count<Scalar> ndf{0};
  kalman::status status{};
  /// Index of the site whose step failed.
  std::size_t failed_at = no_failure;
};

}  // namespace scifi::kalman
