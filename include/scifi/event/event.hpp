// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <concepts>
#include <ranges>
#include <vector>

#include <scifi/event/candidate.hpp>
#include <scifi/event/cluster.hpp>
#include <scifi/event/digit.hpp>
#include <scifi/event/space_point.hpp>
#include <scifi/event/track.hpp>

namespace scifi {

/// What a stage had to leave out of an event. Nothing is dropped without one of these being set.
struct event_flags {
  bool digits_left_out = false;        ///< a digit of no channel or of one that had a digit already, or with light that is no number
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
  void clear();
};

/// An event that the chain can fill: `event`, or a type of a host framework with members (values or references) of these names. Its digits are a contiguous
/// range of any digit_record, which the chain sorts; the rest are vectors as in `event`.
/// Laws: a member named twice gives the same object; no two events share one.
template <class E>
concept event_record = requires(E& e) {
  requires std::ranges::contiguous_range<decltype((e.digits))>;
  requires digit_record<std::ranges::range_value_t<decltype((e.digits))>>;
  { e.clusters } -> std::same_as<std::vector<cluster>&>;
  { e.space_points } -> std::same_as<std::vector<space_point>&>;
  { e.candidates } -> std::same_as<std::vector<candidate>&>;
  { e.tracks } -> std::same_as<std::vector<track>&>;
  { e.track_points } -> std::same_as<std::vector<track_point>&>;
  { e.flags } -> std::same_as<event_flags&>;
};
static_assert(event_record<event>);

/// Empties what the chain makes of the digits but keeps the memory.
template <event_record Event>
void clear_reconstruction(Event& e) {
  e.clusters.clear();
  e.space_points.clear();
  e.candidates.clear();
  e.tracks.clear();
  e.track_points.clear();
  e.flags = {};
}

inline void event::clear() {
  digits.clear();
  clear_reconstruction(*this);
}

}  // namespace scifi
