// SPDX-License-Identifier: MPL-2.0
#include "unit/kalman/dense.hpp"

#include <cmath>

namespace dense {

matrix symmetric(const matrix& c) { return 0.5 * (c + c.transpose()); }

matrix random_matrix(std::mt19937_64& engine, int rows, int cols) {
  std::normal_distribution<double> normal;
  matrix m(rows, cols);
  for (int j = 0; j < cols; ++j)
    for (int i = 0; i < rows; ++i) m(i, j) = normal(engine);
  return m;
}

matrix random_covariance(std::mt19937_64& engine, int n, double floor) {
  const matrix a = random_matrix(engine, n, n);
  return symmetric(a * a.transpose() + floor * matrix::Identity(n, n));
}

matrix random_rotation(std::mt19937_64& engine, int n) { return matrix(Eigen::HouseholderQR<matrix>(random_matrix(engine, n, n)).householderQ()); }

knowledge random_knowledge(std::mt19937_64& engine, int n) {
  matrix mean = random_matrix(engine, n, 1);
  return {std::move(mean), random_covariance(engine, n)};
}

observation random_observation(std::mt19937_64& engine, int n, int m) {
  matrix z = random_matrix(engine, m, 1), h = random_matrix(engine, m, n);
  return {std::move(z), std::move(h), random_covariance(engine, m)};
}

std::pair<double, double> extreme_eigenvalues(const matrix& c) {
  const matrix values = Eigen::SelfAdjointEigenSolver<matrix>(c, Eigen::EigenvaluesOnly).eigenvalues();
  return {values.minCoeff(), values.maxCoeff()};
}

double distance(const knowledge& a, const knowledge& b) {
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

}  // namespace dense
