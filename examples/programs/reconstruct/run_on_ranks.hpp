// SPDX-License-Identifier: MPL-2.0
#pragma once

#ifdef SCIFI_HAS_MPI
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <deque>
#include <exception>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <mpi.h>

#include "ranks.hpp"
#include "reconstruct/block_message.hpp"
#include "reconstruct/progress.hpp"
#include "reconstruct/track_block.hpp"
#include "reconstruct/track_tables.hpp"
#include "run_program.hpp"

namespace on_ranks {

enum tag : int { work, end, result };

/// A message that has arrived. Waits without taking the processor from those that work.
[[nodiscard]] inline MPI_Status wait_for_message(int from, int with_tag) {
  constexpr std::chrono::microseconds pause{50};
  while (true) {
    int there = 0;
    MPI_Status status{};
    MPI_Iprobe(from, with_tag, MPI_COMM_WORLD, &there, &status);
    if (there != 0) return status;
    std::this_thread::sleep_for(pause);
  }
}

inline void receive(const MPI_Status& status, std::vector<char>& into) {
  int bytes = 0;
  MPI_Get_count(&status, MPI_BYTE, &bytes);
  into.resize(static_cast<std::size_t>(bytes));
  MPI_Recv(into.data(), bytes, MPI_BYTE, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
}

[[nodiscard]] inline int length_of(const std::string& message) {
  if (message.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) throw std::runtime_error("a block of events is too large for a message between ranks");
  return static_cast<int>(message.size());
}

/// What all ranks but the first do: reconstruct what they are sent until they are told to end. What goes wrong ends the job.
template <class Chain>
void follow(const ranks& all, const Chain& chain, bool with_points, const monitor::counts& counts) {
  constexpr int leader = 0;
  typename Chain::buffers buffers;
  track_block b;
  b.seen = counts;
  std::vector<char> in;
  std::string out;
  try {
    while (true) {
      const MPI_Status status = wait_for_message(leader, MPI_ANY_TAG);
      receive(status, in);
      if (status.MPI_TAG == end) return;
      block_message::take_events(in, b);
      work_on(b, chain, buffers, with_points);
      block_message::put_results(out, b);
      MPI_Send(out.data(), length_of(out), MPI_BYTE, leader, result, MPI_COMM_WORLD);
    }
  } catch (const std::exception& e) {
    all.speak();
    fmt::print(stderr, "scifi-reconstruct: rank {}: {}\n", all.rank(), e.what());
    ranks::abort(exit_not_done);
  }
}

/// The ranks that work for the first one. They end with this object.
class workers {
 public:
  explicit workers(const ranks& all) : queues_(static_cast<std::size_t>(all.size() - 1)) {}
  workers(const workers&) = delete;
  workers& operator=(const workers&) = delete;
  ~workers() {
    while (outstanding() > 0 && wait()) static_cast<void>(take());
    if (interruption::received() != 0) return;  // the job is going to be aborted: a rank may be gone for good
    for (std::size_t w = 0; w < queues_.size(); ++w) MPI_Send(nullptr, 0, MPI_BYTE, rank_of(w), end, MPI_COMM_WORLD);
  }

  [[nodiscard]] std::size_t outstanding() const {
    std::size_t sum = 0;
    for (const auto& q : queues_) sum += q.size();
    return sum;
  }
  /// How many blocks wait at the one that has least to do.
  [[nodiscard]] std::size_t shortest_queue() const { return idlest()->size(); }

  /// Gives block `number` to the one that has least to do.
  void give(std::size_t number, const track_block& b) {
    const auto to = static_cast<std::size_t>(idlest() - queues_.begin());
    queues_[to].emplace_back();
    sent& s = queues_[to].back();
    s.number = number;
    block_message::put_events(s.message, b);
    MPI_Isend(s.message.data(), length_of(s.message), MPI_BYTE, rank_of(to), work, MPI_COMM_WORLD, &s.request);
  }

  /// True where a result can be taken at once.
  [[nodiscard]] static bool something_came() {
    int there = 0;
    MPI_Iprobe(MPI_ANY_SOURCE, result, MPI_COMM_WORLD, &there, MPI_STATUS_IGNORE);
    return there != 0;
  }
  /// Waits until a result can be taken; false where a signal came instead.
  [[nodiscard]] static bool wait() {
    constexpr std::chrono::microseconds pause{50};
    while (interruption::received() == 0) {
      if (something_came()) return true;
      std::this_thread::sleep_for(pause);
    }
    return false;
  }
  /// The number of the block whose results have come, which `message` then has. After `wait` or `something_came`.
  std::size_t take() {
    const MPI_Status status = wait_for_message(MPI_ANY_SOURCE, result);
    receive(status, message_);
    auto& queue = queues_[static_cast<std::size_t>(status.MPI_SOURCE - 1)];
    MPI_Wait(&queue.front().request, MPI_STATUS_IGNORE);
    const std::size_t number = queue.front().number;
    queue.pop_front();
    return number;
  }
  [[nodiscard]] std::span<const char> message() const { return message_; }

 private:
  struct sent {
    std::size_t number = 0;
    std::string message;
    MPI_Request request = MPI_REQUEST_NULL;
  };
  using queues = std::vector<std::deque<sent>>;

  [[nodiscard]] static int rank_of(std::size_t worker) { return static_cast<int>(worker) + 1; }
  [[nodiscard]] queues::const_iterator idlest() const {
    return std::min_element(queues_.begin(), queues_.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  }

  queues queues_;  // every worker answers in the order in which it was asked
  std::vector<char> message_;
};

/// What the first rank does: reads blocks, has them reconstructed, does some itself when all others have enough, and writes the rows in the order of the
/// input. A fixed number of blocks is in memory. Throws as `run_ordered_blocks`, and interruption::interrupted when a signal ends it.
template <class Chain>
void lead(workers& others, const ranks& all, block_reader& reader, const Chain& chain, track_tables& tables, progress& display, const monitor::counts& counts) {
  constexpr std::size_t enough = 3;  // blocks at a rank: as many as it may do while this one is at a block of its own
  struct slot {
    track_block block;
    bool ready = false;
  };
  std::vector<slot> ring(enough * static_cast<std::size_t>(all.size()));
  for (slot& s : ring) s.block.seen = counts;
  typename Chain::buffers buffers;
  std::size_t next_read = 0;
  std::size_t next_written = 0;
  bool more = true;
  const auto room = [&] { return more && next_read - next_written < ring.size(); };
  while (true) {
    for (bool mine = false; !mine && room();) {
      if (others.outstanding() > 0 && workers::something_came()) break;
      mine = others.shortest_queue() >= enough;
      slot& s = ring[next_read % ring.size()];
      more = reader.read(s.block);
      if (!more) break;
      if (mine) work_on(s.block, chain, buffers, tables.with_points());
      else others.give(next_read, s.block);
      s.ready = mine;
      ++next_read;
    }
    if (others.outstanding() > 0 && (workers::something_came() || !room())) {
      if (!workers::wait()) throw interruption::interrupted();
      slot& s = ring[others.take() % ring.size()];
      block_message::take_results(others.message(), s.block);
      s.ready = true;
    }
    for (; next_written != next_read && ring[next_written % ring.size()].ready; ++next_written) {
      slot& s = ring[next_written % ring.size()];
      tables.write(s.block);
      s.ready = false;
      display.update(reader.source().file().consumed(), tables.sum().events);
    }
    if (!more && next_written == next_read) return;
  }
}

}  // namespace on_ranks
#else
#include "ranks.hpp"
#include "reconstruct/progress.hpp"
#include "reconstruct/track_block.hpp"
#include "reconstruct/track_tables.hpp"

namespace on_ranks {

/// Built without MPI: there is nobody else.
struct workers {
  explicit workers(const ranks&) {}
};
template <class Chain>
void follow(const ranks&, const Chain&, bool, const monitor::counts&) {}
template <class Chain>
void lead(workers&, const ranks&, block_reader&, const Chain&, track_tables&, progress&, const monitor::counts&) {}

}  // namespace on_ranks
#endif
