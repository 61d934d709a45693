// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace scifi::alignment {

/// A number that belongs to a global parameter: a derivative, or a coefficient of a constraint.
struct coefficient {
  int parameter = 0;
  double value = 0.0;
};

/// The measurements of one track, linearised in the parameters q of the track (local) and a of the alignment (global):
///   measured - predicted(q, a) = residual - local dq - global da + error,  error of standard deviation sigma, independent of all others.
///
/// `local` and `global` are the derivatives of the predicted value. Correlated measurements are made independent first (see track_linearisation).
/// Handed in again it keeps its memory.
class track_equations {
 public:
  struct row {
    double residual = 0.0;
    double sigma = 1.0;
    std::span<const double> local;
    std::span<const coefficient> global;
  };

  /// Forgets the measurements; the next track has this number of parameters of its own.
  void clear(int local_parameters) {
    locals_ = static_cast<std::size_t>(local_parameters);
    priors_ = 0;
    rows_.clear();
    local_.clear();
    global_.clear();
  }

  /// One measurement; `local` has one number for each parameter of the track, `global` names the parameters that it depends on, each once.
  void add(double residual, double sigma, std::span<const double> local, std::span<const coefficient> global) {
    rows_.push_back({residual, sigma, global_.size(), global.size()});
    local_.insert(local_.end(), local.begin(), local.begin() + static_cast<std::ptrdiff_t>(locals_));
    global_.insert(global_.end(), global.begin(), global.end());
  }

  /// What is believed of the track before it is measured, far wider than what the measurements say: takes part, but is no degree of freedom.
  void add_wide_prior(double residual, double sigma, std::span<const double> local) {
    add(residual, sigma, local, {});
    ++priors_;
  }

  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] int wide_priors() const { return priors_; }
  [[nodiscard]] int local_parameters() const { return static_cast<int>(locals_); }
  [[nodiscard]] row operator[](std::size_t i) const {
    const stored& r = rows_[i];
    return {r.residual, r.sigma, std::span(local_).subspan(i * locals_, locals_), std::span(global_).subspan(r.first, r.count)};
  }
  /// All global derivatives, of one measurement after the other.
  [[nodiscard]] std::span<const coefficient> global() const { return global_; }

 private:
  struct stored {
    double residual, sigma;
    std::size_t first, count;  // of its global derivatives
  };
  std::size_t locals_ = 0;
  int priors_ = 0;
  std::vector<stored> rows_;
  std::vector<double> local_;
  std::vector<coefficient> global_;
};

}  // namespace scifi::alignment
