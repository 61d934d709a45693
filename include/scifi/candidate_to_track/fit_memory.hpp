// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <scifi/core/linalg.hpp>
#include <scifi/event/candidate.hpp>
#include <scifi/event/cluster.hpp>
#include <scifi/event/space_point.hpp>
#include <scifi/event/track.hpp>
#include <scifi/kalman/in_some_lanes.hpp>
#include <scifi/kalman/node.hpp>
#include <scifi/track_model/fibre_measurement.hpp>

namespace scifi {

/// A candidate to be fitted, with the event it belongs to.
struct fit_job {
  const candidate* from = nullptr;
  int index = 0;  ///< of the candidate in its event
  std::span<const space_point> points;
  std::span<const cluster> clusters;
};

/// A track and its points, in order of growing z; none where the fit failed. Kept and handed in again it stops asking for memory.
struct fitted_track {
  track summary;
  std::vector<track_point> points;
};

/// Appends a track and its points to those of its event.
inline void append(const fitted_track& one, std::vector<track>& tracks, std::vector<track_point>& points) {
  tracks.push_back(one.summary);
  tracks.back().first_point = static_cast<int>(points.size());
  points.insert(points.end(), one.points.begin(), one.points.end());
}

/// One surface of the way of a fit and what was measured there: Scalar is a number, or a pack with one track a lane.
template <class StateSpace, class Scalar, class Leg>
struct fit_stop {
  using measurement_type = kalman::in_some_lanes<fibre_measurement<StateSpace, Scalar>, kalman::mask<Scalar>>;
  std::optional<std::reference_wrapper<const Leg>> step;
  std::optional<measurement_type> measurement;
};

/// Working memory of the fit in one state space.
template <class StateSpace, class Scalar, class Leg>
struct fit_memory {
  std::vector<fit_stop<StateSpace, Scalar, Leg>> stops;
  std::vector<kalman::node<Scalar, StateSpace::dimension, 1>> nodes;
  std::vector<vector<Scalar, StateSpace::dimension>> references;
  std::vector<int> cluster_at;  ///< lane after lane, for each surface; -1: none
};

}  // namespace scifi
