// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <oneapi/tbb/enumerable_thread_specific.h>

#include <scifi/alignment/tracker_alignment.hpp>
#include <scifi/geometry/tracker.hpp>

#include "align/modes.hpp"
#include "interruption.hpp"
#include "reconstruct/chains.hpp"
#include "reconstruct/event_block.hpp"
#include "reconstruct/event_source.hpp"
#include "reconstruct/ordered_blocks.hpp"
#include "reconstruct/progress.hpp"

/// One tracker and how its alignment went.
struct aligned_tracker {
  scifi::alignment::tracker_alignment work;
  std::optional<scifi::alignment::tracker_sum> first, last;  // what the first and the last pass gathered
};

/// Reconstructs all events of a file, read for the `whole` detector, in the geometry found so far with make_chain(geometry) and gathers the tracks; one sum for each
/// of `trackers`.
template <class MakeChain>
[[nodiscard]] std::vector<scifi::alignment::tracker_sum> gather(const std::string& digits, const scifi::detector& whole, const MakeChain& make_chain,
                                                                const std::vector<aligned_tracker>& trackers, int threads) {
  namespace alignment = scifi::alignment;
  scifi::detector now;
  for (const aligned_tracker& t : trackers) now.trackers.push_back(t.work.where());
  const auto chain = make_chain(now);
  using chain_type = std::remove_cvref_t<decltype(chain)>;
  using collector = alignment::track_collector<std::remove_cvref_t<decltype(chain.trackers().front().fit_track)>>;

  std::vector<collector> collect;
  std::vector<alignment::tracker_sum> empty;
  for (std::size_t i = 0; i < trackers.size(); ++i) {
    collect.emplace_back(trackers[i].work.parameters(), chain.trackers()[i].fit_track, trackers[i].work.cuts());
    empty.push_back(collect.back().empty());
  }
  std::vector<alignment::tracker_sum> sums = empty;

  struct block : event_block {
    std::vector<alignment::tracker_sum> sums;
  };
  struct memory {
    typename chain_type::buffers reconstruction;
    typename collector::buffers collection;
  };
  tbb::enumerable_thread_specific<memory> memories;
  event_source source(digits, whole);  // digits of trackers that are not aligned are no mistake
  block_reader reader(source);
  progress display(source.file().size());
  long read = 0;
  const auto work = [&](block& b) {
    memory& m = memories.local();
    b.sums = empty;
    reconstruct(chain, b.content(), m.reconstruction);
    for (const scifi::event& e : b.content())
      for (std::size_t k = 0; k < collect.size(); ++k) collect[k](e, b.sums[k], m.collection);
  };
  const auto add = [&](const block& b, std::uintmax_t bytes_read) {
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += b.sums[k];
    read += static_cast<long>(b.used);
    display.update(bytes_read, read);
  };
  run_ordered_blocks(reader, threads, block(), work, add);
  interruption::throw_if_received();
  if (reader.mistake()) std::rethrow_exception(reader.mistake());
  return sums;
}

/// Says why the parameters of a tracker were not found.
[[noreturn]] inline void give_up(const aligned_tracker& t) {
  const scifi::alignment::solution& s = t.work.last();
  std::string what = fmt::format("tracker {}: {}", t.work.where().id, describe(s.status));
  for (int i = 0; i < s.undetermined; ++i) what += "\n  not determined: " + in_words(s.modes[static_cast<std::size_t>(i)], t.work.parameters());
  throw std::runtime_error(what);
}

/// Pass after pass, at most `passes`, until nothing moves any more. Trackers without tracks are taken off the list. Throws std::runtime_error where the
/// parameters cannot be found, with what is not determined, and interruption::interrupted where a signal came.
template <class MakeChain>
void align(const std::string& digits, int passes, int max_threads, const scifi::detector& whole, const MakeChain& make_chain, std::vector<aligned_tracker>& trackers) {
  const int threads = number_of_threads(max_threads);
  const auto settled = [&trackers] { return std::all_of(trackers.begin(), trackers.end(), [](const aligned_tracker& t) { return t.work.settled(); }); };
  for (int i = 0; i < passes && !settled(); ++i) {
    std::vector<scifi::alignment::tracker_sum> sums = gather(digits, whole, make_chain, trackers, threads);
    for (std::size_t k = trackers.size(); k-- > 0;) {
      aligned_tracker& t = trackers[k];
      if (sums[k].equations.tracks() == 0) {
        fmt::print(stderr, "note: tracker {}: no tracks; it is left as it is\n", t.work.where().id);
        trackers.erase(trackers.begin() + static_cast<std::ptrdiff_t>(k));
        continue;
      }
      t.work.step(sums[k]);
      if (t.work.last().status != scifi::alignment::failure::none) give_up(t);
      if (!t.first) t.first = sums[k];
      t.last = std::move(sums[k]);
    }
    if (trackers.empty()) throw std::runtime_error(digits + ": no tracks to align with");
  }
}
