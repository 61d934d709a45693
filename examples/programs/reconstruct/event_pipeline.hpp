// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <vector>

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_pipeline.h>

#include "reconstruct/event_block.hpp"
#include "reconstruct/progress.hpp"
#include "reconstruct/track_tables.hpp"

/// Reads blocks of events, reconstructs them on `threads` threads and writes the rows in the order of the input: the bytes written do not
/// depend on the number of threads. A fixed number of blocks is in memory. When the input turns out bad, the events before it are
/// still written. Rethrows what goes wrong while writing. `counts` are empty histograms for a block.
template <class Reconstruction>
void run_pipeline(block_reader& reader, const Reconstruction& reconstruct, track_tables& tables, int threads, progress& display, const monitor::counts& counts) {
  const std::size_t in_flight = 4 * static_cast<std::size_t>(threads);
  std::vector<event_block> blocks(in_flight);
  for (event_block& b : blocks) b.seen = counts;
  tbb::enumerable_thread_specific<typename Reconstruction::buffers> buffers;
  std::exception_ptr writing_failed;
  std::atomic<bool> stop = false;
  std::atomic<std::uintmax_t> bytes_read = 0;
  std::size_t next_block = 0;

  const auto read = [&](tbb::flow_control& control) -> event_block* {
    // The blocks leave in the order in which they came, at most `in_flight` at a time: the next one in the ring is free.
    event_block& b = blocks[next_block++ % in_flight];
    if (stop) reader.stop();
    if (!reader.read(b)) control.stop();
    bytes_read = reader.source().file().consumed();
    return &b;
  };
  const auto work = [&](event_block* b) {
    work_on(*b, reconstruct, buffers.local(), tables.with_points());
    return b;
  };
  const auto write = [&](const event_block* b) {
    if (writing_failed) return;
    try {
      tables.write(*b);
    } catch (...) {
      writing_failed = std::current_exception();
      stop = true;
      return;
    }
    display.update(bytes_read, tables.sum().events);
  };
  tbb::parallel_pipeline(in_flight, tbb::make_filter<void, event_block*>(tbb::filter_mode::serial_in_order, read) &
                                        tbb::make_filter<event_block*, event_block*>(tbb::filter_mode::parallel, work) &
                                        tbb::make_filter<event_block*, void>(tbb::filter_mode::serial_in_order, write));
  if (writing_failed) std::rethrow_exception(writing_failed);
}
