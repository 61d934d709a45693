// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <scifi/alignment/track_equations.hpp>
#include <scifi/core/inline_vector.hpp>
#include <scifi/core/refuse.hpp>
#include <scifi/geometry/surface.hpp>
#include <scifi/geometry/tracker.hpp>

namespace scifi::alignment {

/// What moves.
enum class level { stations, planes };

/// How it moves, tracker frame: a station along x and y, a plane along its own alpha (all mm), each about z (rad, counter-clockwise seen against +z).
enum class motion { x, y, along, rotation };

/// What is free in the alignment of a tracker.
struct free_motions {
  alignment::level level = alignment::level::stations;
  bool shifts = true;
  bool rotations = true;
  std::vector<int> held;  ///< ids of stations that do not move at all
};

/// One parameter: the motion of a station, or of one of its planes.
struct tracker_parameter {
  int station = 1;
  int plane = -1;  ///< -1: the station as a whole
  motion how = motion::x;

  [[nodiscard]] const char* unit() const { return how == motion::rotation ? "rad" : "mm"; }
};

/// "x", "y", "along", "rotation".
[[nodiscard]] constexpr const char* to_string(motion how) {
  switch (how) {
    case motion::x: return "x";
    case motion::y: return "y";
    case motion::along: return "along";
    case motion::rotation: return "rotation";
  }
  return "unknown motion";
}

/// "station 2 x", "station 2 plane 1 rotation".
[[nodiscard]] inline std::string name_of(const tracker_parameter& p) {
  return "station " + std::to_string(p.station) + (p.plane >= 0 ? " plane " + std::to_string(p.plane) : "") + ' ' + to_string(p.how);
}

/// Derivatives of one measurement: at most two shifts and a rotation.
using motion_derivatives = inline_vector<coefficient, 3>;

/// The global parameters of one tracker, their derivatives and their effect on its geometry.
///
/// A plane at the angle phi in the tracker frame, of a station with origin o, moved along alpha by u, measures alpha = cos(phi) (x - o_x) + sin(phi) (y - o_y) - u.
class tracker_parameters {
 public:
  /// Throws std::invalid_argument when a held station does not exist or nothing is free.
  tracker_parameters(tracker where, free_motions free) : where_(std::move(where)), free_(std::move(free)) {
    for (const int id : free_.held)
      if (std::none_of(where_.stations.begin(), where_.stations.end(), [id](const station& s) { return s.id == id; }))
        scifi::detail::refuse<std::invalid_argument>("there is no station " + std::to_string(id) + " in tracker " + std::to_string(where_.id));
    for (const station& s : where_.stations) {
      if (std::find(free_.held.begin(), free_.held.end(), s.id) != free_.held.end()) continue;
      if (free_.level == level::stations) add(s.id, -1, {motion::x, motion::y});
      else
        for (std::size_t p = 0; p < s.planes.size(); ++p) add(s.id, static_cast<int>(p), {motion::along});
    }
    if (parameters_.empty()) scifi::detail::refuse<std::invalid_argument>("nothing is free in tracker " + std::to_string(where_.id));
  }

  [[nodiscard]] int size() const { return static_cast<int>(parameters_.size()); }
  [[nodiscard]] const tracker_parameter& operator[](int i) const { return parameters_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const tracker& where() const { return where_; }
  [[nodiscard]] const free_motions& free() const { return free_; }

  /// Number of a parameter, or -1 when it is not free.
  [[nodiscard]] int find(int station, int plane, motion how) const {
    for (std::size_t i = 0; i < parameters_.size(); ++i)
      if (parameters_[i].station == station && parameters_[i].plane == plane && parameters_[i].how == how) return static_cast<int>(i);
    return -1;
  }

  /// Derivatives of the coordinate that a surface of this tracker measures at the point (x, y) of the tracker frame (mm).
  [[nodiscard]] motion_derivatives derivatives(const surface& at, double x, double y) const {
    motion_derivatives out;
    const bool of_stations = free_.level == level::stations;
    const int plane = of_stations ? -1 : at.plane;
    const auto add_if_free = [&](motion how, double value) {
      if (const int i = find(at.station, plane, how); i >= 0) out.push_back({i, value});
    };
    for (const station& s : where_.stations) {
      if (s.id != at.station) continue;
      const auto& o = s.in_tracker.origin;
      add_if_free(motion::x, -at.cos_angle);
      add_if_free(motion::y, -at.sin_angle);
      add_if_free(motion::along, -1.0);
      add_if_free(motion::rotation, at.cos_angle * (y - o.y()) - at.sin_angle * (x - o.x()));
    }
    return out;
  }

  /// The tracker moved by `values`, one for each parameter.
  [[nodiscard]] tracker moved(const Eigen::VectorXd& values) const {
    tracker out = where_;
    for (station& s : out.stations) {
      const auto by = [&](int plane, motion how) {
        const int i = find(s.id, plane, how);
        return i < 0 ? 0.0 : values[i];
      };
      s.in_tracker.origin.x() += by(-1, motion::x);
      s.in_tracker.origin.y() += by(-1, motion::y);
      s.in_tracker.angle += by(-1, motion::rotation);
      for (std::size_t i = 0; i < s.planes.size(); ++i) {
        plane& p = s.planes[i];
        const int number = static_cast<int>(i);
        p.angle += by(number, motion::rotation);
        p.central_channel += by(number, motion::along) / p.channel_width;
      }
    }
    return out;
  }

 private:
  void add(int station, int plane, std::vector<motion> shifts) {
    if (free_.shifts)
      for (const motion how : shifts) parameters_.push_back({station, plane, how});
    if (free_.rotations) parameters_.push_back({station, plane, motion::rotation});
  }

  tracker where_;
  free_motions free_;
  std::vector<tracker_parameter> parameters_;
};

}  // namespace scifi::alignment
