// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/Dense>

#include <random>
#include <utility>

#include <scifi/kalman/estimate.hpp>

#include "unit/kalman/models.hpp"

// Linear problems in matrices of any size: a test of many dimensions is compiled once, and only what it tests for each.
namespace dense {

using matrix = Eigen::MatrixXd;

/// Mean (n x 1) and covariance (n x n).
struct knowledge {
  matrix mean, covariance;
};

/// m numbers z = h x with covariance r.
struct observation {
  matrix z, h, r;
};

matrix symmetric(const matrix& c);
matrix random_matrix(std::mt19937_64& engine, int rows, int cols);

/// Eigenvalues from `floor` to about `floor` + 4 n.
matrix random_covariance(std::mt19937_64& engine, int n, double floor = 0.1);

matrix random_rotation(std::mt19937_64& engine, int n);

knowledge random_knowledge(std::mt19937_64& engine, int n);

observation random_observation(std::mt19937_64& engine, int n, int m);

/// Smallest and largest.
std::pair<double, double> extreme_eigenvalues(const matrix& c);

/// Largest difference of two estimates, means in units of the standard deviations of `a`, covariances as correlations.
double distance(const knowledge& a, const knowledge& b);

template <int Rows, int Cols>
[[nodiscard]] scifi::matrix<double, Rows, Cols> fixed(const matrix& m) {
  return Eigen::Map<const scifi::matrix<double, Rows, Cols>>(m.data());
}

template <class Fixed>
[[nodiscard]] matrix any_size(const Fixed& m) {
  return Eigen::Map<const matrix>(m.data(), m.rows(), m.cols());
}

template <int N>
[[nodiscard]] scifi::kalman::estimate<double, N> fixed_estimate(const knowledge& k) {
  return {fixed<N, 1>(k.mean), fixed<N, N>(k.covariance)};
}

template <int N>
[[nodiscard]] knowledge knowledge_of(const scifi::kalman::estimate<double, N>& e) {
  return {any_size(e.mean), any_size(e.covariance)};
}

template <int N, int M>
[[nodiscard]] models::linear_values<N, M> fixed_values(const observation& o) {
  return {fixed<M, 1>(o.z), fixed<M, N>(o.h), fixed<M, M>(o.r)};
}

}  // namespace dense
