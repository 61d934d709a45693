// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <Eigen/Dense>

#include <cmath>
#include <random>

#include <scifi/core/linalg.hpp>
#include <scifi/kalman/model_value.hpp>

// Small models that the tests of the filter share.
namespace models {

/// Position and velocity; a step is a time.
struct constant_velocity {
  scifi::matrix<double, 2, 2> transition(double dt) const {
    scifi::matrix<double, 2, 2> f;
    f << 1.0, dt, 0.0, 1.0;
    return f;
  }
};

/// White acceleration of spectral density q, for both directions of time.
struct white_acceleration {
  double q;
  scifi::matrix<double, 2, 2> covariance(double dt) const {
    const double t = std::abs(dt);
    scifi::matrix<double, 2, 2> c;
    c << t * t * t / 3.0, dt * t / 2.0, dt * t / 2.0, t;
    return q * c;
  }
};

struct position {
  double z;
  double sigma;
  double value() const { return z; }
  double covariance() const { return sigma * sigma; }
  scifi::matrix<double, 1, 2> projection() const { return {1.0, 0.0}; }
};

/// M measured values with any H and R.
template <int N, int M>
struct linear_values {
  scifi::vector<double, M> z;
  scifi::matrix<double, M, N> h;
  scifi::matrix<double, M, M> r;
  const scifi::vector<double, M>& value() const { return z; }
  const scifi::matrix<double, M, N>& projection() const { return h; }
  const scifi::matrix<double, M, M>& covariance() const { return r; }
};

/// A step that brings its own matrices, and the model that reads them.
template <int N>
struct matrix_step {
  scifi::matrix<double, N, N> f, q;
};
struct step_transition {
  template <int N>
  const scifi::matrix<double, N, N>& transition(const matrix_step<N>& s) const { return s.f; }
};
struct step_noise {
  template <int N>
  const scifi::matrix<double, N, N>& covariance(const matrix_step<N>& s) const { return s.q; }
};

template <int Rows, int Cols>
scifi::matrix<double, Rows, Cols> random_matrix(std::mt19937_64& engine) {
  std::normal_distribution<double> normal;
  scifi::matrix<double, Rows, Cols> m;
  for (int i = 0; i < Rows; ++i)
    for (int j = 0; j < Cols; ++j) m(i, j) = normal(engine);
  return m;
}

/// A covariance with eigenvalues of at least `floor`: A A' + floor.
template <int N>
scifi::matrix<double, N, N> random_covariance(std::mt19937_64& engine, double floor = 0.1) {
  const scifi::matrix<double, N, N> a = random_matrix<N, N>(engine);
  scifi::matrix<double, N, N> c;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j <= i; ++j) c(i, j) = c(j, i) = a.row(i).dot(a.row(j)) + (i == j ? floor : 0.0);
  return c;
}

}  // namespace models
