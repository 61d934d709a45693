// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include <scifi/chain/reconstruction.hpp>
#include <scifi/core/random.hpp>
#include <scifi/event/event.hpp>
#include <scifi/geometry/mice.hpp>

#include "support/ideal_clusters.hpp"

namespace scifi::test {

using standard_chain = decltype(make_reconstruction(std::declval<const detector&>(), std::declval<const reconstruction_options&>()));
using standard_fitter = std::remove_cvref_t<decltype(std::declval<const standard_chain&>().trackers().front().fit_track)>;

/// One call for all tests, compiled once: it is what takes longest.
void reconstruct(const standard_chain& chain, event& e);

/// One tracker of MICE as a detector.
inline detector one_tracker(int id) {
  detector all = mice::trackers();
  return {{all.trackers[static_cast<std::size_t>(id)]}};
}

/// Tracks that neither scatter nor slow in a tracker, as digits: each in the channel that it crosses. Every event has one.
inline std::vector<event> crossing_tracks(const tracker& t, double field, int count, std::uint64_t seed) {
  random_stream random(seed, 0, 0);
  std::vector<event> out;
  for (int i = 0; i < count; ++i) {
    vector<double, 5> start;
    const double pz = t.beam_direction * random.uniform(180.0, 240.0);
    const double slopes = field != 0.0 ? 0.15 : 0.02;
    start << random.uniform(-60.0, 60.0), slopes * random.normal(), random.uniform(-60.0, 60.0), slopes * random.normal(), 1.0 / pz;
    std::vector<cluster> clusters;
    add_ideal_track(t, start, field, clusters);
    event e;
    e.number = i;
    for (const cluster& c : clusters) e.digits.push_back({{c.tracker, c.station, c.plane, static_cast<int>(std::lround(c.channel))}, 10.0});
    out.push_back(e);
  }
  return out;
}

}  // namespace scifi::test
