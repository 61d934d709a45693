// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include <scifi/alignment/failure.hpp>
#include <scifi/alignment/track_equations.hpp>
#include <scifi/core/linalg.hpp>
#include <scifi/kalman/concepts.hpp>

namespace scifi::alignment {

/// One coordinate that was measured on the way of a track, linear in the state there.
template <int N>
struct stop_measurement {
  int site = 0;           ///< where on the way
  double residual = 0.0;  ///< measured - predicted from the state given for the site
  double variance = 1.0;
  matrix<double, 1, N> projection = matrix<double, 1, N>::Zero();
  std::span<const coefficient> global;  ///< derivatives of the predicted value in the global parameters
};

/// A track as equations for the alignment, with everything that disturbs it on its way, about a reference that may itself have been disturbed.
///
/// The parameters of the track are its state at the first site. Scattering and straggling make the measurements correlated: with the noise Q of each step
/// carried along by the Jacobians F, cov(state_i, state_j) = P_i F(j<-i)', P_j = F P_i F' + Q, and the equations are made independent by the
/// inverse of the Cholesky factor of that covariance. Kinks as further parameters (general broken lines; Kleinwort, NIM A 673 (2012) 107)
/// are the same problem; the covariance takes every noise that a filter takes, thick layers and straggling too, and is cheap for some tens of measurements.
template <class Propagator, class ProcessNoise, int N>
class track_linearisation {
 public:
  track_linearisation(Propagator propagator, ProcessNoise noise) : propagator_(std::move(propagator)), noise_(std::move(noise)) {}

  /// Working memory.
  struct buffers {
    std::vector<vector<double, N>> carried;  // of each measurement before: its state's covariance with the state here, projected
    Eigen::MatrixXd covariance, equations;   // equations: local derivatives, residual, global derivatives
    std::vector<int> columns;                // global parameters of the track
    std::vector<coefficient> row;
  };

  /// Appends the equations of a track to `out`, which was cleared for N parameters. `reference` are the states at the sites (those of a smoother: the track
  /// with its kinks), steps[i] leads from site i - 1 to site i (steps[0] is not used); measurements in the order of their sites.
  template <class Steps>
  [[nodiscard]] failure operator()(std::span<const vector<double, N>> reference, const Steps& steps, std::span<const stop_measurement<N>> measurements,
                                   track_equations& out, buffers& work) const {
    const auto m = static_cast<Eigen::Index>(measurements.size());
    find_columns(measurements, work.columns);
    const auto g = static_cast<Eigen::Index>(work.columns.size());
    work.covariance.setZero(m, m);
    work.equations.setZero(m, N + 1 + g);
    work.carried.clear();

    matrix<double, N, N> from_start = matrix<double, N, N>::Identity();
    matrix<double, N, N> noise = matrix<double, N, N>::Zero();
    vector<double, N> kinks = vector<double, N>::Zero();  // what the reference was disturbed by so far
    Eigen::Index next = 0;
    for (std::size_t site = 0; site < reference.size(); ++site) {
      if (site > 0) {
        const auto moved = kalman::propagate(propagator_, reference[site - 1], steps[site]);
        const matrix<double, N, N>& f = moved.jacobian;
        from_start = f * from_start;
        noise = f * noise * f.transpose() + kalman::detail::noise_covariance<double, N>(noise_, reference[site - 1], steps[site], moved);
        kinks = f * kinks + (reference[site] - moved.state);
        for (vector<double, N>& c : work.carried) c = f * c;
      }
      for (; next < m && measurements[static_cast<std::size_t>(next)].site == static_cast<int>(site); ++next) {
        const stop_measurement<N>& at = measurements[static_cast<std::size_t>(next)];
        for (Eigen::Index i = 0; i < next; ++i)
          work.covariance(next, i) = work.covariance(i, next) = at.projection.dot(work.carried[static_cast<std::size_t>(i)].transpose());
        work.carried.push_back(noise * at.projection.transpose());
        work.covariance(next, next) = at.variance + at.projection.dot(work.carried.back().transpose());
        work.equations.row(next).template head<N>() = at.projection * from_start;
        work.equations(next, N) = at.residual + at.projection.dot(kinks.transpose());
        for (const coefficient& c : at.global) work.equations(next, N + 1 + column(work.columns, c.parameter)) += c.value;
      }
    }
    return append(work, out);
  }

 private:
  static void find_columns(std::span<const stop_measurement<N>> measurements, std::vector<int>& columns) {
    columns.clear();
    for (const stop_measurement<N>& at : measurements)
      for (const coefficient& c : at.global)
        if (std::find(columns.begin(), columns.end(), c.parameter) == columns.end()) columns.push_back(c.parameter);
  }
  [[nodiscard]] static Eigen::Index column(const std::vector<int>& columns, int parameter) { return std::find(columns.begin(), columns.end(), parameter) - columns.begin(); }

  [[nodiscard]] static failure append(buffers& work, track_equations& out) {
    if (!std::isfinite(work.covariance.squaredNorm()) || !std::isfinite(work.equations.squaredNorm())) return failure::not_finite;
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> cholesky(work.covariance);
    if (cholesky.info() != Eigen::Success) return failure::not_positive_definite;
    cholesky.matrixL().solveInPlace(work.equations);
    for (Eigen::Index i = 0; i < work.equations.rows(); ++i) {
      const vector<double, N> local = work.equations.row(i).template head<N>();
      work.row.clear();
      for (std::size_t k = 0; k < work.columns.size(); ++k) work.row.push_back({work.columns[k], work.equations(i, N + 1 + static_cast<Eigen::Index>(k))});
      out.add(work.equations(i, N), 1.0, std::span(local.data(), N), work.row);
    }
    return failure::none;
  }

  Propagator propagator_;
  ProcessNoise noise_;
};

}  // namespace scifi::alignment
