// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <scifi/alignment/failure.hpp>
#include <scifi/alignment/track_collector.hpp>
#include <scifi/alignment/track_equations.hpp>
#include <scifi/alignment/tracker_parameters.hpp>
#include <scifi/event/event.hpp>
#include <scifi/geometry/mice.hpp>

namespace scifi::test {

/// The standard chain in one tracker, and what the alignment makes of its tracks. Compiled once for all tests: it is what takes longest.
class tracks_of_chain {
 public:
  tracks_of_chain(const alignment::tracker_parameters& parameters, double field, const alignment::track_cuts& cuts = {});
  void reconstruct(event& e);
  void collect(const event& e, alignment::tracker_sum& sum);
  [[nodiscard]] alignment::failure equations(const event& e, const track& t, alignment::track_equations& out);

 private:
  struct parts;
  std::shared_ptr<parts> parts_;
};

/// One tracker of MICE.
inline tracker tracker_of_mice(int id) { return mice::trackers().trackers[static_cast<std::size_t>(id)]; }

/// Tracks that neither scatter nor slow in a tracker, as digits: each in the channel that it crosses. Every event has one.
std::vector<event> crossing_tracks(const tracker& t, double field, int count, std::uint64_t seed);

}  // namespace scifi::test
