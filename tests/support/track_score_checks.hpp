// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>

#include "support/catch.hpp"
#include "support/track_score.hpp"

namespace scifi::test {

/// A limit holds for the detector, a set of events is a sample: so many standard errors are granted.
struct limits {
  double errors = 2.0;

  void at_least(const share& s, double limit) const {
    CAPTURE(s.expected, s.found, s.value(), limit);
    CHECK(s.value() + errors * s.error() >= limit);
  }

  void spread_at_most(const sample& s, double limit) const {
    CAPTURE(s.size(), s.spread(), limit);
    CHECK(s.spread() * (1.0 - errors * s.relative_error_of_spread()) <= limit);
  }

  void unit_spread(const sample& pull) const {
    const double error = errors * pull.spread() * pull.relative_error_of_spread();
    CAPTURE(pull.size(), pull.spread());
    CHECK(pull.spread() + error > 0.95);
    CHECK(pull.spread() - error < 1.05);
  }

  void unit_mean(const sample& chi2_per_ndf) const {
    CAPTURE(chi2_per_ndf.size(), chi2_per_ndf.mean());
    CHECK(chi2_per_ndf.mean() + errors * chi2_per_ndf.error_of_mean() > 0.95);
    CHECK(chi2_per_ndf.mean() - errors * chi2_per_ndf.error_of_mean() < 1.05);
  }

  /// Poisson.
  void ghosts_at_most(long ghosts, long trials, double limit) const {
    const double allowed = limit * static_cast<double>(trials);
    CAPTURE(ghosts, trials);
    CHECK(static_cast<double>(ghosts) <= allowed + errors * std::sqrt(allowed));
  }

  /// That of a Gaussian core; the median of n such numbers has the standard error 1.2533 sigma/sqrt(n).
  void median_zero(const sample& s) const {
    CAPTURE(s.size(), s.median(), s.spread());
    CHECK(std::abs(s.median()) < errors * 1.2533 * s.spread() / std::sqrt(static_cast<double>(s.size())));
  }
};

}  // namespace scifi::test
