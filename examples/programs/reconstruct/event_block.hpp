// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <scifi/event/event.hpp>
#include <scifi/io/input_error.hpp>

#include "interruption.hpp"
#include "reconstruct/check_sum.hpp"
#include "reconstruct/event_source.hpp"

/// Events that are worked on together. Programs derive from it what they find in them.
struct event_block {
  std::vector<scifi::event> events;  ///< `used` of them count, the others are memory to be used again
  std::size_t used = 0;
  std::uint32_t input_check = 0;  ///< check sum of the input up to the last of them
  bool whole = false;             ///< false where the input ended or went bad within it

  [[nodiscard]] std::span<scifi::event> content() { return {events.data(), used}; }
};

/// Cuts the input into blocks, by their content alone: what is found in one does not depend on who works on it.
class block_reader {
 public:
  explicit block_reader(event_source& source) : source_(source) {}

  /// Passes over events that an earlier run did. Throws scifi::input_error where they are not those of that run.
  void skip(long events, std::uint32_t input_check) {
    scifi::event e;
    for (long i = 0; i < events; ++i) {
      interruption::throw_if_received();
      if (!source_.read(e)) break;
      add_to_check(e);
    }
    if (check_.check != input_check)
      throw scifi::input_error(source_.file().name(), 0, "", "its first " + std::to_string(events) + " events are not those of the run to be resumed; start without --resume");
  }

  /// Puts the next events into `b`; false when there are none: the end of the input, a signal, or a mistake.
  [[nodiscard]] bool read(event_block& b) {
    constexpr std::size_t most_events = 256;
    constexpr std::size_t enough_digits = 8192;
    b.used = 0;
    b.whole = false;
    if (done_ || interruption::received() != 0) return false;
    try {
      std::size_t digits = 0;
      while (b.used < most_events && digits < enough_digits) {
        if (b.used == b.events.size()) b.events.emplace_back();
        scifi::event& e = b.events[b.used];
        if (!source_.read(e)) {
          done_ = true;
          break;
        }
        add_to_check(e);
        digits += e.digits.size();
        ++b.used;
      }
      b.whole = !done_;
    } catch (...) {
      done_ = true;
      mistake_ = std::current_exception();
    }
    if (interruption::received() != 0) {
      // What came from a pipe may have ended for the same reason, anywhere.
      b.used = 0;
      mistake_ = nullptr;
    }
    b.input_check = check_.check;
    return b.used > 0;
  }
  /// Nothing more is wanted.
  void stop() { done_ = true; }

  /// What stopped the reading before the end of the input, if something did.
  [[nodiscard]] const std::exception_ptr& mistake() const { return mistake_; }
  [[nodiscard]] const event_source& source() const { return source_; }

 private:
  void add_to_check(const scifi::event& e) {
    static_assert(std::is_trivially_copyable_v<scifi::digit> && sizeof(scifi::digit) == 4 * sizeof(int) + sizeof(double), "a digit has no gaps");
    check_.add(&e.number, sizeof e.number);
    check_.add(e.digits.data(), e.digits.size() * sizeof(scifi::digit));
  }

  event_source& source_;
  bool done_ = false;
  check_sum check_;
  std::exception_ptr mistake_;
};
