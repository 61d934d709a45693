// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <initializer_list>

#include <scifi/event/candidate.hpp>
#include <scifi/event/space_point.hpp>

namespace scifi::test {

/// A space point of these clusters, and nothing else said of it.
inline space_point point_of(std::initializer_list<int> clusters) {
  space_point p;
  p.clusters = clusters;
  return p;
}

/// A candidate of these space points, with a seed of zeros.
inline candidate candidate_of(std::initializer_list<int> points, double chi2) {
  candidate c;
  c.space_points = points;
  c.seed.mean.setZero();
  c.seed.covariance.setZero();
  c.chi2 = chi2;
  return c;
}

}  // namespace scifi::test
