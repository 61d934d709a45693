// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <vector>

#include <scifi/event/candidate.hpp>
#include <scifi/event/cluster.hpp>
#include <scifi/event/digit.hpp>
#include <scifi/event/space_point.hpp>
#include <scifi/event/track.hpp>

namespace scifi {

/// What a stage had to leave out of an event. Nothing is dropped without one of these being set.
struct event_flags {
  bool combinations_limited = false;   ///< a combinatorial search reached its bound
  bool fit_failed = false;             ///< at least one candidate could not be fitted
  friend constexpr bool operator==(const event_flags&, const event_flags&) = default;
};

/// One event: values, linked by indices into each other, from digits to tracks. Hand it back in for the next event: its memory is reused.
/// track -> candidate -> space_points -> clusters -> digits; track -> track_points -> clusters.
struct event {
  long number = 0;
  std::vector<digit> digits;  ///< sorted by id after clustering
  std::vector<cluster> clusters;
  std::vector<space_point> space_points;
  std::vector<candidate> candidates;
  std::vector<track> tracks;
  std::vector<track_point> track_points;
  event_flags flags;

  /// Empties everything but keeps the memory.
  void clear() {
    digits.clear();
    clear_reconstruction();
  }
  /// Empties what was made of the digits.
  void clear_reconstruction() {
    clusters.clear();
    space_points.clear();
    candidates.clear();
    tracks.clear();
    track_points.clear();
    flags = {};
  }
};

}  // namespace scifi
