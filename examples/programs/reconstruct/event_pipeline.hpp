// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_pipeline.h>

#include <scifi/event/event.hpp>
#include <scifi/io/atomic_file.hpp>
#include <scifi/io/track_writer.hpp>

#include "reconstruct/event_source.hpp"
#include "reconstruct/monitor.hpp"
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

/// Reads blocks of events, reconstructs them on `threads` threads and writes the rows in the order of the input: the bytes written do not
/// depend on the number of threads. A fixed number of blocks is in memory. When the input turns out bad, the events before it are
/// still written. Rethrows what goes wrong while writing. `watch` sees every event.
template <class Reconstruction>
[[nodiscard]] pipeline_result run_pipeline(event_source& source, const Reconstruction& reconstruct, scifi::atomic_file& tracks_file,
                                           std::optional<scifi::atomic_file>& points_file, int threads, progress& display, monitor& watch) {
  struct block {
    std::vector<scifi::event> events;
    std::size_t used = 0;
    std::string tracks, points;
    totals sum;
  };
  constexpr std::size_t most_events = 256;
  constexpr std::size_t enough_digits = 8192;
  const std::size_t in_flight = 4 * static_cast<std::size_t>(threads);
  std::vector<block> blocks(in_flight);
  tbb::enumerable_thread_specific<typename Reconstruction::buffers> buffers;
  pipeline_result result;
  std::exception_ptr writing_failed;
  std::atomic<bool> stop = false;
  std::atomic<std::uintmax_t> bytes_read = 0;
  std::size_t next_block = 0;

  const auto read = [&](tbb::flow_control& control) -> block* {
    // The blocks leave in the order in which they came, at most `in_flight` at a time: the next one in the ring is free.
    block& b = blocks[next_block++ % in_flight];
    b.used = 0;
    std::size_t digits = 0;
    bool more = !stop;
    try {
      while (more && b.used < most_events && digits < enough_digits) {
        if (b.used == b.events.size()) b.events.emplace_back();
        more = source.read(b.events[b.used]);
        if (more) digits += b.events[b.used++].digits.size();
      }
    } catch (...) {
      result.reading_stopped = std::current_exception();
      stop = true;
    }
    bytes_read = source.file().consumed();
    if (b.used == 0) control.stop();
    return &b;
  };
  const auto work = [&](block* b) {
    b->tracks.clear();
    b->points.clear();
    b->sum = {};
    monitor::watcher watching = watch.watch();
    const std::span events(b->events.data(), b->used);
    const auto start = std::chrono::steady_clock::now();
    reconstruct(events, buffers.local());
    b->sum.reconstruction += std::chrono::steady_clock::now() - start;
    for (const scifi::event& e : events) {
      scifi::append_tracks(b->tracks, e);
      if (points_file) scifi::append_track_points(b->points, e);
      b->sum.count(e);
      watching.add(e);
    }
    return b;
  };
  const auto write = [&](const block* b) {
    if (writing_failed) return;
    try {
      tracks_file.write(b->tracks);
      if (points_file) points_file->write(b->points);
    } catch (...) {
      writing_failed = std::current_exception();
      stop = true;
      return;
    }
    result.sum.add(b->sum);
    display.update(bytes_read, result.sum.events);
  };
  tbb::parallel_pipeline(in_flight, tbb::make_filter<void, block*>(tbb::filter_mode::serial_in_order, read) &
                                        tbb::make_filter<block*, block*>(tbb::filter_mode::parallel, work) &
                                        tbb::make_filter<block*, void>(tbb::filter_mode::serial_in_order, write));
  if (writing_failed) std::rethrow_exception(writing_failed);
  return result;
}
