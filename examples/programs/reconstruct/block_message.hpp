// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include <scifi/event/event.hpp>

#include "reconstruct/track_block.hpp"

/// Blocks of events as bytes for another process of the same program on a machine of the same kind: the digits one way, what was found in them the other.
namespace block_message {

namespace detail {

template <class Value>
void put(std::string& out, const Value* values, std::size_t count) {
  static_assert(std::is_trivially_copyable_v<Value>);
  out.append(reinterpret_cast<const char*>(&count), sizeof count);
  out.append(reinterpret_cast<const char*>(values), count * sizeof(Value));
}

/// Takes what `put` put from the front of `from`; `into` is resized.
template <class Container>
void take(std::span<const char>& from, Container& into) {
  using value = typename Container::value_type;
  std::size_t count = 0;
  const auto copy = [&from](void* to, std::size_t bytes) {
    if (bytes > from.size()) throw std::runtime_error("a message between ranks is cut short");
    if (bytes > 0) std::memcpy(to, from.data(), bytes);
    from = from.subspan(bytes);
  };
  copy(&count, sizeof count);
  if (count > from.size() / sizeof(value)) throw std::runtime_error("a message between ranks is cut short");
  into.resize(count);
  copy(into.data(), count * sizeof(value));
}

}  // namespace detail

inline void put_events(std::string& out, const event_block& b) {
  out.clear();
  std::vector<long> numbers;
  for (std::size_t i = 0; i < b.used; ++i) numbers.push_back(b.events[i].number);
  detail::put(out, numbers.data(), numbers.size());
  for (std::size_t i = 0; i < b.used; ++i) detail::put(out, b.events[i].digits.data(), b.events[i].digits.size());
}

inline void take_events(std::span<const char> from, event_block& b) {
  std::vector<long> numbers;
  detail::take(from, numbers);
  b.used = numbers.size();
  if (b.events.size() < b.used) b.events.resize(b.used);
  for (std::size_t i = 0; i < b.used; ++i) {
    b.events[i].clear();
    b.events[i].number = numbers[i];
    detail::take(from, b.events[i].digits);
  }
}

inline void put_results(std::string& out, track_block& b) {
  out.clear();
  detail::put(out, &b.sum, 1);
  detail::put(out, b.tracks.data(), b.tracks.size());
  detail::put(out, b.points.data(), b.points.size());
  const std::vector<double> seen = b.seen ? b.seen->contents() : std::vector<double>();
  detail::put(out, seen.data(), seen.size());
}

inline void take_results(std::span<const char> from, track_block& b) {
  std::vector<totals> sum;
  detail::take(from, sum);
  if (sum.size() != 1) throw std::runtime_error("a message between ranks is not what was expected");
  b.sum = sum.front();
  detail::take(from, b.tracks);
  detail::take(from, b.points);
  std::vector<double> seen;
  detail::take(from, seen);
  if (!b.seen) return;
  b.seen->clear();
  if (!b.seen->add_contents(seen)) throw std::runtime_error("a rank watches another detector");
}

}  // namespace block_message
