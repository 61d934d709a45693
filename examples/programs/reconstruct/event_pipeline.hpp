// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <string>

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <scifi/event/event.hpp>
#include <scifi/io/atomic_file.hpp>
#include <scifi/io/track_writer.hpp>

#include "reconstruct/event_source.hpp"
#include "reconstruct/monitor.hpp"
#include "reconstruct/ordered_blocks.hpp"
#include "reconstruct/progress.hpp"

/// What is counted on the way.
struct totals {
  long events = 0, digits = 0, clusters = 0, space_points = 0, candidates = 0, tracks = 0, failures = 0;
  long flagged = 0, combinations_limited = 0, fit_failed = 0;
  std::chrono::steady_clock::duration reconstruction{};  ///< on one thread

  void count(const scifi::event& e) {
    ++events;
    digits += static_cast<long>(e.digits.size());
    clusters += static_cast<long>(e.clusters.size());
    space_points += static_cast<long>(e.space_points.size());
    candidates += static_cast<long>(e.candidates.size());
    for (const scifi::track& t : e.tracks) ++(t.status.ok() ? tracks : failures);
    flagged += e.flags != scifi::event_flags{};
    combinations_limited += e.flags.combinations_limited;
    fit_failed += e.flags.fit_failed;
  }
  void add(const totals& more) {
    events += more.events;
    digits += more.digits;
    clusters += more.clusters;
    space_points += more.space_points;
    candidates += more.candidates;
    tracks += more.tracks;
    failures += more.failures;
    flagged += more.flagged;
    combinations_limited += more.combinations_limited;
    fit_failed += more.fit_failed;
    reconstruction += more.reconstruction;
  }
};

/// How a run ended: what was counted, and what stopped the reading before the end of the input, if something did.
struct pipeline_result {
  totals sum;
  std::exception_ptr reading_stopped;
};

/// Reconstructs the events on `threads` threads and writes the rows in the order of the input: the bytes written do not depend on the number of
/// threads. When the input turns out bad, the events before it are still written. Rethrows what goes wrong while writing. `watch` sees every event.
template <class Reconstruction>
[[nodiscard]] pipeline_result run_pipeline(event_source& source, const Reconstruction& reconstruct, scifi::atomic_file& tracks_file,
                                           std::optional<scifi::atomic_file>& points_file, int threads, progress& display, monitor& watch) {
  struct block : event_block {
    std::string tracks, points;
    totals sum;
  };
  tbb::enumerable_thread_specific<typename Reconstruction::buffers> buffers;
  pipeline_result result;
  const auto work = [&](block& b) {
    b.tracks.clear();
    b.points.clear();
    b.sum = {};
    monitor::watcher watching = watch.watch();
    const std::span events(b.events.data(), b.used);
    const auto start = std::chrono::steady_clock::now();
    reconstruct(events, buffers.local());
    b.sum.reconstruction += std::chrono::steady_clock::now() - start;
    for (const scifi::event& e : events) {
      scifi::append_tracks(b.tracks, e);
      if (points_file) scifi::append_track_points(b.points, e);
      b.sum.count(e);
      watching.add(e);
    }
  };
  const auto write = [&](const block& b, std::uintmax_t bytes_read) {
    tracks_file.write(b.tracks);
    if (points_file) points_file->write(b.points);
    result.sum.add(b.sum);
    display.update(bytes_read, result.sum.events);
  };
  result.reading_stopped = run_ordered_blocks<block>(source, threads, work, write);
  return result;
}
