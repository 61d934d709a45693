// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <scifi/core/refuse.hpp>
#include <scifi/core/units.hpp>
#include <scifi/track_model/q_over_pz_prior.hpp>

namespace scifi {

/// What pattern recognition may assume and where it cuts.
struct track_finder_options {
  double field = 0.0;              ///< Bz in the tracker frame, (MeV/c)/(e mm); zero: straight tracks
  double line_momentum = 200.0;    ///< MeV/c along z, assumed for straight tracks
  int line_charge = 1;             ///< sign, assumed for straight tracks
  int min_stations = 4;            ///< of a candidate
  double largest_slope = 0.6;      ///< pt/pz
  double smallest_pz = 50.0;       ///< MeV/c
  double tight_gate = 14.0;        ///< largest squared distance of a point from its prediction, two degrees of freedom (p = 9e-4) ...
  double tight_chi2_per_ndf = 3.5; ///< ... and largest chi2 of a candidate, in the first search, which clears most points away
  double tight_point_chi2 = 9.0;   ///< ... and largest chi2 of a space point (one degree of freedom, p = 0.003): above it lie half of the false crossings
  double gate = 30.0;              ///< the same (p = 3e-7) ...
  double chi2_per_ndf = 12.0;      ///< ... in the second search, for tracks that scattered hard
  double sure_chi2_per_ndf = 2.5;  ///< largest chi2 of a candidate, points and arc, in the search for sure ones that comes first where points crowd ...
  long crowd = 1000;               ///< ... which is where the first three stations have more triples of points than this: about six tracks
  double cluster_gain = 10.0;      ///< chi2 that one cluster more is worth when candidates compete
  q_over_pz_prior prior{};         ///< of either sign of curvature
  double dim_light = 5.0;          ///< photo-electrons per cluster below which a space point may be noise: a particle leaves about 12, thermal noise 2 to 3
  int max_dim_points = 1;          ///< such points in a candidate
  int max_shared_clusters = 3;     ///< with better candidates: two tracks may cross the same channel
  int max_shared_of_sure = 6;      ///< where sure ones are chosen together
  int max_arc_fits = 100000;       ///< bound on the search in one tracker ...
  long max_looks = 20'000'000;     ///< ... and on the space points that it looks at, each time it does

  /// Throws std::invalid_argument, naming the culprit, where no track can be expected.
  void check() const {
    const auto positive = [](double x) { return x > 0.0 && std::isfinite(x); };
    if (!std::isfinite(field)) detail::refuse<std::invalid_argument>("track_finder_options: the field must be finite");
    if (std::abs(field) > 100.0 * units::tesla)
      detail::refuse<std::invalid_argument>("track_finder_options: the field is beyond 100 T; it is given in (MeV/c)/(e mm), 3 T is 3.0 * units::tesla");
    if (!positive(line_momentum)) detail::refuse<std::invalid_argument>("track_finder_options: the momentum of straight tracks must be above zero");
    if (!positive(largest_slope)) detail::refuse<std::invalid_argument>("track_finder_options: the largest slope must be above zero");
    if (!positive(smallest_pz)) detail::refuse<std::invalid_argument>("track_finder_options: the smallest pz must be above zero");
    if (!positive(prior.typical) || !(prior.spread >= 0.0 && std::isfinite(prior.spread)))
      detail::refuse<std::invalid_argument>("track_finder_options: the prior of q/pz needs a typical value above zero and a spread that is not negative");
    if (!(prior.typical * smallest_pz <= 1.0)) detail::refuse<std::invalid_argument>("track_finder_options: the typical q/pz of the prior belongs to a pz below the smallest");
  }
};

/// 1 / momentum (c/MeV) along z to be expected of a track with curvature w (rad/mm): bounded, so that an unbent track is not taken for one that does not
/// scatter; that of the momentum given where there is no field.
[[nodiscard]] inline double expected_inverse_momentum(const track_finder_options& o, double w) {
  if (o.field == 0.0) return 1.0 / o.line_momentum;
  const double least = 0.5 * (o.prior.typical - 0.75 * o.prior.spread);
  return std::clamp(std::abs(w / o.field), least, 1.0 / o.smallest_pz);
}

/// Momentum (MeV/c) to be expected of a track with curvature w (rad/mm) and squared slope t2.
[[nodiscard]] inline double expected_momentum(const track_finder_options& o, double w, double t2) {
  if (o.field == 0.0) return o.line_momentum;
  return std::sqrt(1.0 + t2) / expected_inverse_momentum(o, w);
}

}  // namespace scifi
