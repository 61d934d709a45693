// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <vector>

#include <oneapi/tbb/parallel_pipeline.h>

#include <scifi/event/event.hpp>

#include "reconstruct/event_source.hpp"

/// Some events that are worked on together.
struct event_block {
  std::vector<scifi::event> events;
  std::size_t used = 0;
};

/// Reads blocks of events, calls work(block) for them on `threads` threads and finish(block, bytes_read) one after the other in the order of the input:
/// what finish adds up does not depend on the number of threads. A fixed number of blocks is in memory. When the input turns out bad, the
/// events before it are still finished, and what stopped the reading is returned. Rethrows what goes wrong in finish.
template <class Block, class Work, class Finish>
[[nodiscard]] std::exception_ptr run_ordered_blocks(event_source& source, int threads, const Work& work, const Finish& finish) {
  constexpr std::size_t most_events = 256;
  constexpr std::size_t enough_digits = 8192;
  const std::size_t in_flight = 4 * static_cast<std::size_t>(threads);
  std::vector<Block> blocks(in_flight);
  std::exception_ptr reading_stopped, finishing_failed;
  std::atomic<bool> stop = false;
  std::atomic<std::uintmax_t> bytes_read = 0;
  std::size_t next_block = 0;

  const auto read = [&](tbb::flow_control& control) -> Block* {
    // The blocks leave in the order in which they came, at most `in_flight` at a time: the next one in the ring is free.
    Block& b = blocks[next_block++ % in_flight];
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
      reading_stopped = std::current_exception();
      stop = true;
    }
    bytes_read = source.file().consumed();
    if (b.used == 0) control.stop();
    return &b;
  };
  const auto work_on = [&](Block* b) {
    work(*b);
    return b;
  };
  const auto finish_with = [&](Block* b) {
    if (finishing_failed) return;
    try {
      finish(*b, bytes_read.load());
    } catch (...) {
      finishing_failed = std::current_exception();
      stop = true;
    }
  };
  tbb::parallel_pipeline(in_flight, tbb::make_filter<void, Block*>(tbb::filter_mode::serial_in_order, read) &
                                        tbb::make_filter<Block*, Block*>(tbb::filter_mode::parallel, work_on) &
                                        tbb::make_filter<Block*, void>(tbb::filter_mode::serial_in_order, finish_with));
  if (finishing_failed) std::rethrow_exception(finishing_failed);
  return reading_stopped;
}
