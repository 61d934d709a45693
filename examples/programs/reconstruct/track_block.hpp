// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <chrono>
#include <span>
#include <string>

#include <scifi/event/event.hpp>
#include <scifi/io/track_writer.hpp>

#include "reconstruct/chains.hpp"
#include "reconstruct/event_block.hpp"
#include "reconstruct/monitor.hpp"
#include "reconstruct/totals.hpp"

/// Events and the tracks that were found in them.
struct track_block : event_block {
  std::string tracks, points;  ///< rows of tables
  totals sum;
  monitor::counts seen;
};

/// Reconstructs a block and writes the rows.
template <class Chain>
void work_on(track_block& b, const Chain& chain, typename Chain::buffers& buffers, bool with_points) {
  b.tracks.clear();
  b.points.clear();
  b.sum = {};
  const auto start = std::chrono::steady_clock::now();
  reconstruct(chain, b.content(), buffers);
  b.sum.reconstruction += std::chrono::steady_clock::now() - start;
  if (b.seen) b.seen->clear();
  for (const scifi::event& e : b.content()) {
    scifi::append_tracks(b.tracks, e);
    if (with_points) scifi::append_track_points(b.points, e);
    b.sum.count(e);
    if (b.seen) b.seen->add(e);
  }
}
