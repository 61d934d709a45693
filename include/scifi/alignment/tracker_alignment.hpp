// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
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
  /// By how much the last step moved a parameter at most, over its standard deviation.
  [[nodiscard]] double largest_change() const { return largest_change_; }
  [[nodiscard]] int steps() const { return steps_; }

  /// Moves the geometry by what a pass says. Where that fails, `last().status` says why and nothing moves.
  ///
  /// The tracks are not the same in each pass: one may have 15 planes here and 12 there, or stand at the edge of a cut. Then there may be no place that a pass
  /// leaves as it is, and full steps would go to and fro. The n-th step (with the final cuts) that does not ask for less than half of what the one before
  /// asked for is divided by n + 1: the geometry comes to rest between.
  void step(const tracker_sum& sum) {
    // Derivatives taken at tracks that scattered tell a rotation of everything from none, by the square of scattering over distance: some 1e-4.
    constexpr double smallest_share = 1.0e-3;
    last_ = solve(sum.equations, frame_constraints(start_, keep_), smallest_share);
    if (last_.status != failure::none) return;
    ++steps_;
    // The tracks that are looked at next are as bad as these at most.
    constexpr double hardly_less = 0.95;
    const double scale = std::max(1.0, sum.scale.median());
    final_cuts_ = cuts_.chi2_scale > 0.0 && scale >= hardly_less * cuts_.chi2_scale;
    cuts_.chi2_scale = scale;

    double asked = 0.0;
    for (int i = 0; i < start_.size(); ++i)
      if (last_.sigma(i) > 0.0) asked = std::max(asked, std::abs(last_.values[i]) / last_.sigma(i));
    if (asked > 0.5 * asked_before_) ++divisor_;
    asked_before_ = final_cuts_ ? asked : std::numeric_limits<double>::infinity();
    largest_change_ = asked / divisor_;
    moved_ += last_.values / divisor_;
    now_ = tracker_parameters(start_.moved(moved_), start_.free());
  }

  /// True once a step with the final cuts moved no parameter by more than this share of its standard deviation.
  [[nodiscard]] bool settled(double share = 0.1) const { return final_cuts_ && largest_change_ <= share; }

 private:
  tracker_parameters start_, now_;
  frame keep_;
  track_cuts cuts_;
  Eigen::VectorXd moved_;
  solution last_;
  double largest_change_ = 0.0;
  double asked_before_ = std::numeric_limits<double>::infinity();  // change over error, of the step before, where its cuts were the final ones
  int steps_ = 0, divisor_ = 1;
  bool final_cuts_ = false;  // of the last step: the scale of chi2 no longer falls
};

}  // namespace scifi::alignment
