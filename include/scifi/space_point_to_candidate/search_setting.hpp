// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <scifi/arc/chord_turn.hpp>
#include <scifi/geometry/tracker.hpp>
#include <scifi/material/particle.hpp>
#include <scifi/space_point_to_candidate/station_scattering.hpp>
#include <scifi/space_point_to_candidate/track_finder_options.hpp>

namespace scifi {

/// What a search needs to know of a tracker and of the tracks in it.
class search_setting {
 public:
  /// Throws std::invalid_argument where check(tracker) does.
  template <class Scattering>
  search_setting(const tracker& where, const track_finder_options& assumed, const particle& hypothesis, const Scattering& matter)
      : id(where.id), travel(where.beam_direction), scattering(where, hypothesis, matter), options(assumed) {
    check(where);
    std::vector<double> z;
    for (const station& s : where.stations) {
      stations.push_back(s.id);
      double sum = 0.0;
      for (const plane& p : s.planes) sum += s.in_tracker.child_to_parent({0.0, 0.0, p.z_measured}).z();
      z.push_back(s.planes.empty() ? s.in_tracker.origin.z() : sum / static_cast<double>(s.planes.size()));
    }
    for (std::size_t third = 2; third < z.size(); ++third)
      for (std::size_t second = 1; second < third; ++second)
        for (std::size_t first = 0; first < second; ++first)
          turns_.emplace_back(z[second] - z[first], z[third] - z[second], std::abs(options.field) / options.smallest_pz);
  }

  /// Chords between three stations, numbers in order of growing z.
  [[nodiscard]] const chord_turn& turn(std::size_t first, std::size_t second, std::size_t third) const {
    return turns_[third * (third - 1) * (third - 2) / 6 + second * (second - 1) / 2 + first];
  }

  int id;                     ///< of the tracker
  int travel;                 ///< direction of the beam in z
  std::vector<int> stations;  ///< ids in order of growing z
  station_scattering scattering;
  track_finder_options options;

 private:
  std::vector<chord_turn> turns_;
};

}  // namespace scifi
