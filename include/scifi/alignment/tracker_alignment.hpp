// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Core>

#include <scifi/alignment/frame_constraints.hpp>
#include <scifi/alignment/solution.hpp>
#include <scifi/alignment/track_collector.hpp>
#include <scifi/alignment/tracker_parameters.hpp>

namespace scifi::alignment {

/// How the alignment of a tracker goes on, pass after pass: every pass reconstructs the events in the geometry found so far, since fits, clusters that are
/// taken and chi2 depend on it.
class tracker_alignment {
 public:
  tracker_alignment(const tracker& start, free_motions free, frame keep, const track_cuts& cuts)
      : start_(start, std::move(free)), now_(start_), keep_(keep), cuts_(cuts), moved_(Eigen::VectorXd::Zero(start_.size())) {}

  /// The parameters about the geometry found so far, for the next pass.
  [[nodiscard]] const tracker_parameters& parameters() const { return now_; }
  [[nodiscard]] const tracker& where() const { return now_.where(); }
  [[nodiscard]] const track_cuts& cuts() const { return cuts_; }
  /// What was moved since the start, one number for each parameter.
  [[nodiscard]] const Eigen::VectorXd& moved() const { return moved_; }
  /// Of the last step.
  [[nodiscard]] const solution& last() const { return last_; }
  /// Largest change of a parameter in the last step over its standard deviation.
  [[nodiscard]] double largest_change() const { return largest_change_; }
  [[nodiscard]] int steps() const { return steps_; }

  /// Moves the geometry by what a pass says. Where that fails, `last().status` says why and nothing moves.
  void step(const tracker_sum& sum) {
    // Derivatives taken at tracks that scattered tell a rotation of everything from none, by the square of scattering over distance: some 1e-4.
    constexpr double smallest_share = 1.0e-3;
    last_ = solve(sum.equations, frame_constraints(start_, keep_), smallest_share);
    if (last_.status != failure::none) return;
    ++steps_;
    largest_change_ = 0.0;
    for (int i = 0; i < start_.size(); ++i)
      if (last_.sigma(i) > 0.0) largest_change_ = std::max(largest_change_, std::abs(last_.values[i]) / last_.sigma(i));
    moved_ += last_.values;
    now_ = tracker_parameters(start_.moved(moved_), start_.free());
    // The tracks that are looked at next are as bad as these at most.
    cuts_.chi2_scale = std::max(1.0, sum.scale.median());
  }

  /// True once a step with the final cuts changed no parameter by more than this share of its standard deviation.
  [[nodiscard]] bool settled(double share = 0.1) const { return steps_ > 1 && largest_change_ <= share; }

 private:
  tracker_parameters start_, now_;
  frame keep_;
  track_cuts cuts_;
  Eigen::VectorXd moved_;
  solution last_;
  double largest_change_ = 0.0;
  int steps_ = 0;
};

}  // namespace scifi::alignment
