// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <scifi/alignment/solution.hpp>
#include <scifi/alignment/tracker_parameters.hpp>

namespace scifi::alignment {

/// What keeps the frame of a tracker, which its own tracks do not know: overall shift, shear (shift that grows with z), rotation and, with tracks that are
/// nearly parallel, twist (rotation that grows with z).
enum class frame {
  ends,     ///< the first and the last station stay: they are the axis, as in the survey of MICE
  average,  ///< mean and slope against z of all stations' shifts and rotations stay
  none
};

/// How a station moves as a whole, by the parameters of a tracker. Of free planes: the shift (x, y) that comes nearest to those of the planes along their
/// alpha, and the mean rotation. Empty where the station does not move.
[[nodiscard]] inline std::vector<coefficient> station_motion(const tracker_parameters& parameters, int station_id, motion how) {
  std::vector<coefficient> out;
  if (parameters.free().level == level::stations) {
    if (const int i = parameters.find(station_id, -1, how); i >= 0) out.push_back({i, 1.0});
    return out;
  }
  for (const station& s : parameters.where().stations) {
    if (s.id != station_id) continue;
    const auto planes = static_cast<double>(s.planes.size());
    const auto angle = [&s](std::size_t p) { return s.planes[p].angle + s.in_tracker.angle; };
    // Least squares for (x, y): the matrix sum of (cos, sin)(cos, sin)' has its axes at half the angle of the sum of (cos 2 phi, sin 2 phi), and there the sums
    // (planes +- length of that) / 2. What no plane measures has none, and does not move.
    double cos2 = 0.0, sin2 = 0.0;
    for (std::size_t p = 0; p < s.planes.size(); ++p) {
      cos2 += std::cos(2.0 * angle(p));
      sin2 += std::sin(2.0 * angle(p));
    }
    const double axis = 0.5 * std::atan2(sin2, cos2);
    const double length = std::hypot(cos2, sin2);
    constexpr double none = 1.0e-12;
    const auto nearest = [&](std::size_t p) {
      const double along = std::cos(angle(p) - axis) * 2.0 / (planes + length);
      const double across = planes - length > none * planes ? std::sin(angle(p) - axis) * 2.0 / (planes - length) : 0.0;
      return how == motion::x ? along * std::cos(axis) - across * std::sin(axis) : along * std::sin(axis) + across * std::cos(axis);
    };
    for (std::size_t p = 0; p < s.planes.size(); ++p) {
      const bool turns = how == motion::rotation;
      const int i = parameters.find(station_id, static_cast<int>(p), turns ? motion::rotation : motion::along);
      if (i >= 0) out.push_back({i, turns ? 1.0 / planes : nearest(p)});
    }
  }
  return out;
}

/// The constraints that keep the frame of a tracker; constraints on what is not free are left out.
[[nodiscard]] inline std::vector<constraint> frame_constraints(const tracker_parameters& parameters, frame keep) {
  std::vector<constraint> out;
  const std::vector<station>& stations = parameters.where().stations;
  if (keep == frame::none || stations.empty()) return out;
  const auto add = [&out](std::string name, std::vector<coefficient> coefficients) {
    if (!coefficients.empty()) out.push_back({std::move(name), std::move(coefficients), 0.0});
  };
  for (const motion how : {motion::x, motion::y, motion::rotation}) {
    if (keep == frame::ends) {
      for (const station* end : {&stations.front(), &stations.back()})
        add("station " + std::to_string(end->id) + ' ' + to_string(how), station_motion(parameters, end->id, how));
      continue;
    }
    double middle = 0.0;
    for (const station& s : stations) middle += s.in_tracker.origin.z() / static_cast<double>(stations.size());
    std::vector<coefficient> mean, slope;
    for (const station& s : stations) {
      for (const coefficient& c : station_motion(parameters, s.id, how)) {
        mean.push_back(c);
        slope.push_back({c.parameter, c.value * (s.in_tracker.origin.z() - middle)});
      }
    }
    add(std::string("mean ") + to_string(how), std::move(mean));
    add(std::string("slope of ") + to_string(how) + " against z", std::move(slope));
  }
  return out;
}

}  // namespace scifi::alignment
