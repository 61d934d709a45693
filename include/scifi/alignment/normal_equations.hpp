// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <stdexcept>

#include <Eigen/Core>

#include <scifi/alignment/local_elimination.hpp>
#include <scifi/core/refuse.hpp>

namespace scifi::alignment {

/// The reduced normal equations of the global parameters: matrix a = gradient, summed over tracks.
///
/// Sums over parts of the data (threads, files, machines) are added. Dense: for up to some thousand parameters.
class normal_equations {
 public:
  explicit normal_equations(int parameters)
      : matrix_(Eigen::MatrixXd::Zero(parameters, parameters)), gradient_(Eigen::VectorXd::Zero(parameters)), own_(Eigen::VectorXd::Zero(parameters)) {}

  /// Adds a track; one with a status other than `none` adds nothing.
  void add(const reduced_track& track) {
    if (track.status != failure::none) return;
    const auto g = static_cast<Eigen::Index>(track.parameters.size());
    const auto at = [&track](Eigen::Index i) { return track.parameters[static_cast<std::size_t>(i)]; };
    for (Eigen::Index i = 0; i < g; ++i) {
      gradient_[at(i)] += track.rows.col(i).dot(track.residuals);
      own_[at(i)] += track.own[i];
      for (Eigen::Index j = 0; j <= i; ++j) {
        const double product = track.rows.col(i).dot(track.rows.col(j));
        matrix_(at(i), at(j)) += product;
        if (i != j) matrix_(at(j), at(i)) += product;
      }
    }
    chi2_ += track.chi2;
    ndf_ += track.ndf;
    ++tracks_;
  }

  /// Adds the sum over other tracks. Throws std::invalid_argument when it is over other parameters.
  normal_equations& operator+=(const normal_equations& more) {
    if (more.parameters() != parameters()) scifi::detail::refuse<std::invalid_argument>("scifi::alignment: sums over different numbers of parameters cannot be added");
    matrix_ += more.matrix_;
    gradient_ += more.gradient_;
    own_ += more.own_;
    chi2_ += more.chi2_;
    ndf_ += more.ndf_;
    tracks_ += more.tracks_;
    return *this;
  }

  [[nodiscard]] int parameters() const { return static_cast<int>(gradient_.size()); }
  [[nodiscard]] const Eigen::MatrixXd& matrix() const { return matrix_; }
  [[nodiscard]] const Eigen::VectorXd& gradient() const { return gradient_; }
  /// 1/sigma^2 of each parameter if all tracks and all other parameters were known: the diagonal before the elimination.
  [[nodiscard]] const Eigen::VectorXd& own() const { return own_; }
  [[nodiscard]] double chi2() const { return chi2_; }  ///< with the global parameters as they are
  [[nodiscard]] long ndf() const { return ndf_; }      ///< global parameters not counted
  [[nodiscard]] long tracks() const { return tracks_; }

 private:
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd gradient_, own_;
  double chi2_ = 0.0;
  long ndf_ = 0, tracks_ = 0;
};

}  // namespace scifi::alignment
