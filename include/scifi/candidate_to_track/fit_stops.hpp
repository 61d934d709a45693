// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <scifi/candidate_to_track/fit_memory.hpp>
#include <scifi/candidate_to_track/fit_path.hpp>
#include <scifi/core/lane.hpp>
#include <scifi/core/scalar.hpp>

namespace scifi {

/// Writes down which cluster of a candidate stands at which surface of the way: `cluster_at` has as many elements as the way has surfaces.
inline void assign_clusters(const fit_path& path, const fit_job& job, int* cluster_at) {
  for (std::size_t i = 0; i < path.surfaces.size(); ++i) cluster_at[i] = -1;
  for (const int point : job.from->space_points) {
    for (const int member : job.points[static_cast<std::size_t>(point)].clusters) {
      const cluster& hit = job.clusters[static_cast<std::size_t>(member)];
      for (std::size_t i = 0; i < path.surfaces.size(); ++i)
        if (path.surfaces[i].station == hit.station && path.surfaces[i].plane == hit.plane) cluster_at[i] = member;
    }
  }
}

/// Lays out the stops of a fit: the legs of the way, and at each surface what the candidates, one a lane, have there.
template <class StateSpace, class Scalar, class Leg, std::size_t Width>
void set_stops(const fit_path& path, const std::vector<Leg>& legs, const std::array<fit_job, Width>& jobs, fit_memory<StateSpace, Scalar, Leg>& work) {
  static_assert(static_cast<int>(Width) == lane_count<Scalar>, "scifi: as many candidates are fitted together as the scalar has lanes");
  const std::size_t surfaces = path.surfaces.size();
  work.cluster_at.resize(Width * surfaces);
  for (std::size_t lane = 0; lane < Width; ++lane) assign_clusters(path, jobs[lane], work.cluster_at.data() + lane * surfaces);
  work.stops.resize(surfaces + 1);
  for (std::size_t i = 0; i <= surfaces; ++i) {
    auto& stop = work.stops[i];
    if (i > 0) stop.step = legs[i];
    else stop.step.reset();
    stop.measurement.reset();
    if (i == surfaces) break;
    typename fit_stop<StateSpace, Scalar, Leg>::measurement_type seen{};
    seen.cos_angle = path.surfaces[i].cos_angle;
    seen.sin_angle = path.surfaces[i].sin_angle;
    seen.offset = path.surfaces[i].offset;
    for (std::size_t lane = 0; lane < Width; ++lane) {
      const int at = work.cluster_at[lane * surfaces + i];
      set_lane(seen.where, static_cast<int>(lane), at >= 0);
      if (at < 0) continue;
      const cluster& hit = jobs[lane].clusters[static_cast<std::size_t>(at)];
      set_lane(seen.alpha, static_cast<int>(lane), hit.alpha);
      set_lane(seen.alpha_variance, static_cast<int>(lane), hit.variance);
    }
    if (any_of(seen.where)) stop.measurement = seen;
  }
}

}  // namespace scifi
