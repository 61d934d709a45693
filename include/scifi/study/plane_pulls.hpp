// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <scifi/event/track.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/study/distribution.hpp>
#include <scifi/study/true_state.hpp>
#include <scifi/study/true_track.hpp>
#include <scifi/track_model/slope_state.hpp>

namespace scifi::study {

/// Pulls at one plane.
struct pulls_at_plane {
  int station = 0;
  int plane = 0;
  /// Of the smoothed state (x, tx, y, ty, q/pz) against the truth.
  std::array<distribution, slope_state::dimension> state{pull("x"), pull("tx"), pull("y"), pull("ty"), pull("q/pz")};
  distribution measurement = pull("the measurement");  ///< of the cluster against the fit without it, as a fit to data has it too
  distribution residual{100, -4.0, 4.0, "measured - fitted without it [mm]"};

  pulls_at_plane& operator+=(const pulls_at_plane& other) {
    for (std::size_t i = 0; i < state.size(); ++i) state[i] += other.state[i];
    measurement += other.measurement;
    residual += other.residual;
    return *this;
  }

 private:
  [[nodiscard]] static distribution pull(const char* of) { return distribution(100, -5.0, 5.0, std::string("pull of ") + of); }
};

/// Pulls at every plane of a tracker, in order of growing z. Merged with += where the trackers have the same planes.
class plane_pulls {
 public:
  /// `field`: Bz in the tracker frame, (MeV/c)/(e mm), which moves the truth to the middle of the planes.
  plane_pulls(const tracker& where, double field) : field_(field) {
    for (const station& s : where.stations) {
      for (std::size_t p = 0; p < s.planes.size(); ++p) {
        pulls_at_plane next;
        next.station = s.id;
        next.plane = static_cast<int>(p);
        planes_.push_back(std::move(next));
      }
    }
  }

  /// The points of a particle's track. A component without a standard deviation has no pull.
  void add(const true_track& particle, std::span<const track_point> points) {
    for (const track_point& p : points) {
      for (std::size_t i = 0; i < planes_.size(); ++i) {
        if (planes_[i].station != p.station || planes_[i].plane != p.plane) continue;
        if (std::isfinite(p.pull)) planes_[i].measurement.add(p.pull);
        if (std::isfinite(p.residual)) planes_[i].residual.add(p.residual);
        if (const auto truth = true_state_at(particle, i, p.z, field_)) {
          for (std::size_t k = 0; k < planes_[i].state.size(); ++k) {
            const auto c = static_cast<Eigen::Index>(k);
            const double sigma = kalman::sigma(p.smoothed, c);
            if (sigma > 0.0) planes_[i].state[k].add((p.smoothed.mean[c] - (*truth)[c]) / sigma);
          }
        }
      }
    }
  }
  plane_pulls& operator+=(const plane_pulls& other) {
    for (std::size_t i = 0; i < planes_.size() && i < other.planes_.size(); ++i) planes_[i] += other.planes_[i];
    return *this;
  }

  [[nodiscard]] std::span<const pulls_at_plane> planes() const { return planes_; }

 private:
  double field_;
  std::vector<pulls_at_plane> planes_;
};

}  // namespace scifi::study
