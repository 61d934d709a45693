// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <scifi/alignment/failure.hpp>
#include <scifi/alignment/normal_equations.hpp>
#include <scifi/alignment/track_equations.hpp>

namespace scifi::alignment {

/// A linear constraint: sum of coefficient times parameter = value.
struct constraint {
  std::string name;
  std::vector<coefficient> coefficients;
  double value = 0.0;
};

/// A combination of parameters that the tracks see independently of the others.
struct mode {
  /// Information on it once tracks and all other parameters have to be found too, over that on its parameters were each alone unknown: its error is
  /// 1/sqrt(share) times the one it would have then. 0: not known at all; above 1: tracks compare its parameters directly.
  double share = 0.0;
  Eigen::VectorXd weights;    ///< how much of it each parameter is: squares add up to one
  Eigen::VectorXd direction;  ///< one standard deviation of it, if it were alone, in the units of the parameters
};

/// What the normal equations and the constraints give.
struct solution {
  failure status = failure::none;
  Eigen::VectorXd values;        ///< zero where the status is not `none`
  Eigen::MatrixXd covariance;    ///< likewise; zero along the constraints
  Eigen::VectorXd multipliers;   ///< Lagrange multiplier of each constraint: -1/2 d chi2/d value; zero where it only fixes the frame
  std::vector<mode> modes;       ///< within the constraints, the weakest first
  int undetermined = 0;          ///< the first so many modes are not determined
  double chi2 = 0.0;             ///< with the values
  long ndf = 0;                  ///< with the free parameters counted

  [[nodiscard]] double sigma(int parameter) const { return std::sqrt(covariance(parameter, parameter)); }
};

/// Minimises chi2 under the constraints.
///
/// With Lagrange multipliers, matrix a + C' lambda = gradient and C a = c; this is solved by going to the directions that the constraints leave
/// (null space of C), which gives the same values and, in addition, the spectrum that says what is weak. Parameters are measured in
/// units of the error that each would have alone, so that millimetres and radians compare. A mode with less than `smallest_share` of its information is
/// called undetermined, and then there are no values: with 1e-5 its error is 300 times what it would be alone, and it hangs on details (the distance of
/// the planes within a station) that nobody means to measure with. Constraints that repeat others do no harm, those that contradict them are an error.
[[nodiscard]] inline solution solve(const normal_equations& sum, std::span<const constraint> constraints, double smallest_share = 1.0e-5) {
  const Eigen::Index n = sum.parameters();
  const auto c = static_cast<Eigen::Index>(constraints.size());
  solution out;
  out.values = Eigen::VectorXd::Zero(n);
  out.covariance = Eigen::MatrixXd::Zero(n, n);
  out.multipliers = Eigen::VectorXd::Zero(c);
  out.chi2 = sum.chi2();
  out.ndf = sum.ndf();
  if (!std::isfinite(sum.matrix().squaredNorm()) || !std::isfinite(sum.gradient().squaredNorm())) {
    out.status = failure::not_finite;
    return out;
  }

  const Eigen::VectorXd unit = sum.own().unaryExpr([](double w) { return w > 0.0 ? 1.0 / std::sqrt(w) : 1.0; });
  const Eigen::MatrixXd scaled = unit.asDiagonal() * sum.matrix() * unit.asDiagonal();
  const Eigen::VectorXd gradient = unit.cwiseProduct(sum.gradient());

  // Columns: one constraint each, in the scaled parameters and divided by its length.
  Eigen::MatrixXd across = Eigen::MatrixXd::Zero(n, c);
  Eigen::VectorXd value = Eigen::VectorXd::Zero(c), length = Eigen::VectorXd::Ones(c);
  for (Eigen::Index i = 0; i < c; ++i) {
    const constraint& from = constraints[static_cast<std::size_t>(i)];
    for (const coefficient& k : from.coefficients) {
      if (k.parameter < 0 || k.parameter >= n) {
        out.status = failure::unknown_parameter;
        return out;
      }
      across(k.parameter, i) += k.value * unit[k.parameter];
    }
    if (across.col(i).norm() > 0.0) length[i] = across.col(i).norm();
    across.col(i) /= length[i];
    value[i] = from.value / length[i];
  }

  Eigen::VectorXd fixed = Eigen::VectorXd::Zero(n);  // the point of the constraints nearest to zero
  Eigen::MatrixXd along = Eigen::MatrixXd::Identity(n, n);
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  Eigen::VectorXd work;
  Eigen::Index rank = 0;
  if (c > 0) {
    qr.setThreshold(1.0e-10);
    qr.compute(across);
    rank = qr.rank();
    Eigen::MatrixXd q = along;
    for (Eigen::Index k = std::min(n, c); k-- > 0;) detail::reflect(qr, k, q, work);
    Eigen::VectorXd within = (qr.colsPermutation().transpose() * value).head(rank);
    qr.matrixR().topLeftCorner(rank, rank).triangularView<Eigen::Upper>().transpose().solveInPlace(within);
    fixed = q.leftCols(rank) * within;
    const double allowed = 1.0e-8 * (1.0 + value.norm());
    if (!((across.transpose() * fixed - value).norm() <= allowed)) {
      out.status = failure::contradictory_constraints;
      return out;
    }
    along = q.rightCols(n - rank);
  }

  const Eigen::Index free = along.cols();
  Eigen::VectorXd scaled_values = fixed;
  if (free > 0) {
    const Eigen::MatrixXd inside = along.transpose() * scaled * along;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(inside);
    const Eigen::MatrixXd directions = along * spectrum.eigenvectors();
    for (Eigen::Index i = 0; i < free; ++i) {
      out.modes.push_back({std::max(spectrum.eigenvalues()[i], 0.0), directions.col(i), unit.cwiseProduct(directions.col(i))});
      if (!(spectrum.eigenvalues()[i] > smallest_share)) ++out.undetermined;
    }
    if (out.undetermined > 0) {
      out.status = failure::undetermined_parameters;
      return out;
    }
    const Eigen::VectorXd weights = spectrum.eigenvalues().cwiseInverse();
    const Eigen::VectorXd pull = gradient - scaled * fixed;
    scaled_values += directions * weights.cwiseProduct(directions.transpose() * pull);
    const Eigen::MatrixXd in_units = unit.asDiagonal() * directions;
    out.covariance = in_units * weights.asDiagonal() * in_units.transpose();
  }
  out.values = unit.cwiseProduct(scaled_values);
  const Eigen::VectorXd force = gradient - scaled * scaled_values;
  if (c > 0) {
    Eigen::MatrixXd turned = force;
    for (Eigen::Index k = 0; k < rank; ++k) detail::reflect(qr, k, turned, work);
    Eigen::VectorXd multipliers = Eigen::VectorXd::Zero(c);
    multipliers.head(rank) = turned.col(0).head(rank);
    qr.matrixR().topLeftCorner(rank, rank).triangularView<Eigen::Upper>().solveInPlace(multipliers.head(rank));
    out.multipliers = (qr.colsPermutation() * multipliers).cwiseQuotient(length);
  }
  out.chi2 -= scaled_values.dot(gradient + force);
  out.ndf -= static_cast<long>(free);
  return out;
}

}  // namespace scifi::alignment
