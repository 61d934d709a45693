// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/QR>

#include <scifi/alignment/failure.hpp>
#include <scifi/alignment/track_equations.hpp>

namespace scifi::alignment {

/// What a track says of the global parameters alone, once its own are eliminated: m - p independent equations of error one.
struct reduced_track {
  failure status = failure::none;
  double chi2 = 0.0;  ///< of the track's fit, with the global parameters as they are
  int ndf = 0;        ///< m - p, less the wide priors among the m
  std::vector<int> parameters;  ///< global parameters it depends on, in growing order: the columns below
  Eigen::MatrixXd rows;         ///< (m - p) x parameters
  Eigen::VectorXd residuals;    ///< m - p
  Eigen::VectorXd own;          ///< for each of `parameters`: what the track would say of it if track and other parameters were known, 1/sigma^2
};

namespace detail {

/// Reflection `k` of a QR factorisation, applied to `m` from the left; Q is the product of all of them, the first one leftmost. One by one they are as fast as in
/// blocks for factors of some ten columns, and Eigen's sequence of reflections is slow to compile.
inline void reflect(const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& qr, Eigen::Index k, Eigen::MatrixXd& m, Eigen::VectorXd& work) {
  const Eigen::Index below = qr.rows() - k;
  work.resize(m.cols());
  m.bottomRows(below).applyHouseholderOnTheLeft(qr.matrixQR().col(k).tail(below - 1), qr.hCoeffs()[k], work.data());
}

}  // namespace detail

/// Eliminates the parameters of a track from its m equations.
///
/// Millepede (Blobel and Kleinwort, hep-ex/0208021, section 3) subtracts G' inv(Gamma) G from the normal equations. Here the equations are divided by
/// their errors and turned by the Q of a QR factorisation of the local derivatives; the rows below the first p do not contain the
/// local parameters any more. The sum of squares of those rows is the same, but nothing is subtracted: no digits are lost and it stays semidefinite.
class local_elimination {
 public:
  /// Equations whose parameters are numbered 0 .. parameters - 1. Fails, with `out.status`, where the track does not determine its own parameters.
  void operator()(const track_equations& track, int parameters, reduced_track& out) {
    const auto m = static_cast<Eigen::Index>(track.size());
    const Eigen::Index p = track.local_parameters();
    out.status = prepare(track, parameters, out);
    if (out.status != failure::none) return;

    const auto g = static_cast<Eigen::Index>(out.parameters.size());
    local_.resize(m, p);
    rest_.setZero(m, g + 1);
    for (Eigen::Index i = 0; i < m; ++i) {
      const track_equations::row r = track[static_cast<std::size_t>(i)];
      const double weight = 1.0 / r.sigma;
      for (Eigen::Index k = 0; k < p; ++k) local_(i, k) = weight * r.local[static_cast<std::size_t>(k)];
      for (const coefficient& c : r.global) rest_(i, column(out.parameters, c.parameter)) += weight * c.value;
      rest_(i, g) = weight * r.residual;
    }
    // One finite sum of squares: all numbers are finite.
    if (!std::isfinite(local_.squaredNorm()) || !std::isfinite(rest_.squaredNorm())) {
      out.status = failure::not_finite;
      return;
    }
    out.own = rest_.leftCols(g).colwise().squaredNorm();
    if (p > 0) {
      qr_.compute(local_);
      if (qr_.rank() < p) {
        out.status = failure::singular_track;
        return;
      }
      for (Eigen::Index k = 0; k < p; ++k) detail::reflect(qr_, k, rest_, work_);
    }
    out.rows = rest_.bottomLeftCorner(m - p, g);
    out.residuals = rest_.bottomRightCorner(m - p, 1);
    out.chi2 = out.residuals.squaredNorm();
    out.ndf = static_cast<int>(m - p) - track.wide_priors();
  }

 private:
  /// Finds the global parameters of the track; what is wrong with it.
  [[nodiscard]] static failure prepare(const track_equations& track, int parameters, reduced_track& out) {
    out.parameters.clear();
    out.chi2 = 0.0;
    out.ndf = 0;
    if (track.size() <= static_cast<std::size_t>(track.local_parameters() + track.wide_priors())) return failure::too_few_measurements;
    for (std::size_t i = 0; i < track.size(); ++i)
      if (!(track[i].sigma > 0.0)) return std::isnan(track[i].sigma) ? failure::not_finite : failure::no_error;
    for (const coefficient& c : track.global()) {
      if (c.parameter < 0 || c.parameter >= parameters) return failure::unknown_parameter;
      out.parameters.push_back(c.parameter);
    }
    std::sort(out.parameters.begin(), out.parameters.end());
    out.parameters.erase(std::unique(out.parameters.begin(), out.parameters.end()), out.parameters.end());
    return failure::none;
  }
  [[nodiscard]] static Eigen::Index column(const std::vector<int>& sorted, int parameter) {
    return std::lower_bound(sorted.begin(), sorted.end(), parameter) - sorted.begin();
  }

  Eigen::MatrixXd local_, rest_;
  Eigen::VectorXd work_;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr_;
};

}  // namespace scifi::alignment
