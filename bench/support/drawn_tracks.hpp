// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <random>
#include <vector>

#include <scifi/candidate_to_track/fit_path.hpp>
#include <scifi/core/units.hpp>
#include <scifi/event/candidate.hpp>
#include <scifi/event/cluster.hpp>
#include <scifi/event/space_point.hpp>
#include <scifi/geometry/mice.hpp>
#include <scifi/track_model/helix_propagator.hpp>

namespace drawn {

using scifi::slope_state;

inline constexpr double field = 3.0 * scifi::units::tesla;
inline constexpr int tracks = 64;

/// One track, as pattern recognition would hand it on.
struct one_track {
  scifi::vector<double, 5> at_reference, seed;
  scifi::candidate candidate;
  std::vector<scifi::space_point> points;
  std::vector<scifi::cluster> clusters;
};

/// Helices through the fifteen planes of a tracker with Gaussian errors of measurement.
struct sample {
  scifi::tracker tracker = scifi::mice::trackers().trackers.back();
  scifi::fit_path path = scifi::fit_path_of(tracker);
  std::vector<one_track> tracks;

  sample() {
    std::mt19937_64 engine(2027);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> flat(-1.0, 1.0);
    const scifi::helix_propagator fly{field};
    constexpr double sigma = 0.431;  // 1.4945 mm / sqrt(12)
    for (int t = 0; t < drawn::tracks; ++t) {
      one_track s;
      s.at_reference << 60.0 * flat(engine), 0.2 * flat(engine), 60.0 * flat(engine), 0.2 * flat(engine), 1.0 / (180.0 + 40.0 * flat(engine));
      const double far = path.surfaces.front().z;
      s.seed = fly.propagate(s.at_reference, far - path.z_reference).state;
      s.candidate.tracker = tracker.id;
      s.candidate.z = far;
      s.candidate.seed.mean = s.seed;
      for (const scifi::surface& at : path.surfaces) {
        const scifi::vector<double, 5> x = fly.propagate(s.at_reference, at.z - path.z_reference).state;
        scifi::cluster hit;
        hit.tracker = tracker.id;
        hit.station = at.station;
        hit.plane = at.plane;
        hit.alpha = at.tracker_to_alpha(x[slope_state::x], x[slope_state::y]) + sigma * normal(engine);
        hit.variance = sigma * sigma;
        if (s.points.empty() || s.points.back().station != hit.station) {
          s.candidate.space_points.push_back(static_cast<int>(s.points.size()));
          s.points.emplace_back();
          s.points.back().station = hit.station;
        }
        s.points.back().clusters.push_back(static_cast<int>(s.clusters.size()));
        s.clusters.push_back(hit);
      }
      tracks.push_back(s);
    }
  }
};

inline const sample& given() {
  static const sample s;
  return s;
}

}  // namespace drawn
