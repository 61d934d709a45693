// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <scifi/event/track.hpp>
#include <scifi/geometry/surface.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/study/contents.hpp>
#include <scifi/study/distribution.hpp>
#include <scifi/study/true_state.hpp>
#include <scifi/study/true_track.hpp>
#include <scifi/track_model/slope_state.hpp>

namespace scifi::study {

/// Pulls at one plane.
struct pulls_at_plane {
  int station = 0;
  int plane = 0;
  /// Of the smoothed state (x, tx, y, ty, q/pz) against the truth, with the variance that the truth itself leaves open taken off.
  std::array<distribution, slope_state::dimension> state{pull("x"), pull("tx"), pull("y"), pull("ty"), pull("q/pz")};
  distribution measurement = pull("the measurement");  ///< of the cluster against the fit without it, as a fit to data has it too
  distribution residual{100, -4.0, 4.0, "measured - fitted without it [mm]"};

  pulls_at_plane& operator+=(const pulls_at_plane& other) {
    each(merge, other);
    return *this;
  }
  /// Calls visit(part), or visit(part, the same one of `other`), for everything that is merged.
  template <class Visit, class... Others>
  void each(const Visit& visit, const Others&... other) {
    for (std::size_t i = 0; i < state.size(); ++i) visit(state[i], other.state[i]...);
    visit(measurement, other.measurement...);
    visit(residual, other.residual...);
  }

 private:
  [[nodiscard]] static distribution pull(const char* of) { return distribution(100, -5.0, 5.0, std::string("pull of ") + of); }
};

/// Pulls at every plane of a tracker, in order of growing z. Merged with += where the trackers have the same planes.
class plane_pulls {
 public:
  /// `field`: Bz in the tracker frame, (MeV/c)/(e mm), which moves the truth to the middle of the planes.
  plane_pulls(const tracker& where, double field) : field_(field), surfaces_(surfaces_along(where, +1)) {
    for (const surface& s : surfaces_) {
      pulls_at_plane next;
      next.station = s.station;
      next.plane = s.plane;
      planes_.push_back(std::move(next));
    }
  }

  /// The points of a particle's track. A component without a standard deviation has no pull.
  void add(const true_track& particle, std::span<const track_point> points) {
    for (const track_point& p : points) {
      for (std::size_t i = 0; i < planes_.size(); ++i) {
        if (planes_[i].station != p.station || planes_[i].plane != p.plane) continue;
        if (std::isfinite(p.pull)) planes_[i].measurement.add(p.pull);
        if (std::isfinite(p.residual)) planes_[i].residual.add(p.residual);
        const crossing* const in_front = particle.at[i];
        if (in_front == nullptr) continue;
        const crossing* const behind = i + 1 < particle.at.size() ? particle.at[i + 1] : nullptr;
        const true_state truth = true_state_at(surfaces_[i], *in_front, behind, particle.charge, p.z, field_);
        for (std::size_t k = 0; k < planes_[i].state.size(); ++k) {
          const auto c = static_cast<Eigen::Index>(k);
          const double variance = p.smoothed.covariance(c, c) - truth.open[c];
          if (variance > 0.0) planes_[i].state[k].add((p.smoothed.mean[c] - truth.mean[c]) / std::sqrt(variance));
        }
      }
    }
  }
  plane_pulls& operator+=(const plane_pulls& other) {
    each(merge, other);
    return *this;
  }
  /// Calls visit(part), or visit(part, the same one of `other`), for everything that is merged.
  template <class Visit, class... Others>
  void each(const Visit& visit, const Others&... other) {
    const std::size_t common = std::min({planes_.size(), other.planes_.size()...});
    for (std::size_t i = 0; i < common; ++i) visit(planes_[i], other.planes_[i]...);
  }

  [[nodiscard]] std::span<const pulls_at_plane> planes() const { return planes_; }

 private:
  double field_;
  std::vector<surface> surfaces_;
  std::vector<pulls_at_plane> planes_;
};

}  // namespace scifi::study
