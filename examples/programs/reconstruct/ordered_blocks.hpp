// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <vector>

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include "reconstruct/event_block.hpp"

/// As many threads as were asked for; 0: one for each core.
[[nodiscard]] inline int number_of_threads(int asked) { return asked > 0 ? asked : tbb::info::default_concurrency(); }

/// Reads blocks of events, calls work(block) for them on `threads` threads and finish(block, bytes_read) one after the other in the order of the input: what
/// finish adds up or writes does not depend on the number of threads. A fixed number of blocks is in memory, each a copy of `empty` at first. When the
/// input turns out bad, the events before it are still finished, and the reader knows what stopped it. Rethrows what goes wrong in finish.
template <class Block, class Work, class Finish>
void run_ordered_blocks(block_reader& reader, int threads, const Block& empty, const Work& work, const Finish& finish) {
  const std::size_t in_flight = 4 * static_cast<std::size_t>(threads);
  std::vector<Block> blocks(in_flight, empty);
  std::exception_ptr finishing_failed;
  std::atomic<bool> stop = false;
  std::atomic<std::uintmax_t> bytes_read = 0;
  std::size_t next_block = 0;

  const auto read = [&](tbb::flow_control& control) -> Block* {
    // The blocks leave in the order in which they came, at most `in_flight` at a time: the next one in the ring is free.
    Block& b = blocks[next_block++ % in_flight];
    if (stop) reader.stop();
    if (!reader.read(b)) control.stop();
    bytes_read = reader.source().file().consumed();
    return &b;
  };
  const auto work_on = [&](Block* b) {
    work(*b);
    return b;
  };
  const auto finish_with = [&](const Block* b) {
    if (finishing_failed) return;
    try {
      finish(*b, bytes_read.load());
    } catch (...) {
      finishing_failed = std::current_exception();
      stop = true;
    }
  };
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena(threads).execute([&] {
    tbb::parallel_pipeline(in_flight, tbb::make_filter<void, Block*>(tbb::filter_mode::serial_in_order, read) &
                                          tbb::make_filter<Block*, Block*>(tbb::filter_mode::parallel, work_on) &
                                          tbb::make_filter<Block*, void>(tbb::filter_mode::serial_in_order, finish_with));
  });
  if (finishing_failed) std::rethrow_exception(finishing_failed);
}
