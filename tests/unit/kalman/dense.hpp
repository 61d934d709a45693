// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/Dense>

#include <cmath>
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

inline matrix symmetric(const matrix& c) { return 0.5 * (c + c.transpose()); }

inline matrix random_matrix(std::mt19937_64& engine, int rows, int cols) {
  std::normal_distribution<double> normal;
  matrix m(rows, cols);
  for (int j = 0; j < cols; ++j)
    for (int i = 0; i < rows; ++i) m(i, j) = normal(engine);
  return m;
}

/// Eigenvalues from `floor` to about `floor` + 4 n.
inline matrix random_covariance(std::mt19937_64& engine, int n, double floor = 0.1) {
  const matrix a = random_matrix(engine, n, n);
  return symmetric(a * a.transpose() + floor * matrix::Identity(n, n));
}

inline matrix random_rotation(std::mt19937_64& engine, int n) { return matrix(Eigen::HouseholderQR<matrix>(random_matrix(engine, n, n)).householderQ()); }

inline knowledge random_knowledge(std::mt19937_64& engine, int n) {
  matrix mean = random_matrix(engine, n, 1);
  return {std::move(mean), random_covariance(engine, n)};
}

inline observation random_observation(std::mt19937_64& engine, int n, int m) {
  matrix z = random_matrix(engine, m, 1), h = random_matrix(engine, m, n);
  return {std::move(z), std::move(h), random_covariance(engine, m)};
}

/// Smallest and largest.
inline std::pair<double, double> extreme_eigenvalues(const matrix& c) {
  const matrix values = Eigen::SelfAdjointEigenSolver<matrix>(c, Eigen::EigenvaluesOnly).eigenvalues();
  return {values.minCoeff(), values.maxCoeff()};
}

/// Largest difference of two estimates, means in units of the standard deviations of `a`, covariances as correlations.
inline double distance(const knowledge& a, const knowledge& b) {
  double worst = 0.0;
  const auto widen = [&worst](double d) {
    if (!(std::abs(d) <= worst)) worst = std::abs(d);
  };
  for (Eigen::Index i = 0; i < a.mean.size(); ++i) {
    const double sigma = std::sqrt(a.covariance(i, i));
    widen((a.mean(i) - b.mean(i)) / sigma);
    for (Eigen::Index j = 0; j < a.mean.size(); ++j) widen((a.covariance(i, j) - b.covariance(i, j)) / (sigma * std::sqrt(a.covariance(j, j))));
  }
  return worst;
}

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
