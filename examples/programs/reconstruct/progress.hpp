// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

/// A line on the terminal that says how far the work has come; silent where standard error is not a terminal.
class progress {
 public:
  explicit progress(std::optional<std::uintmax_t> total_bytes) : shown_(::isatty(STDERR_FILENO) != 0), total_(total_bytes) {}
  progress(const progress&) = delete;
  progress& operator=(const progress&) = delete;
  ~progress() { clear(); }

  void update(std::uintmax_t bytes, long events) {
    const auto now = std::chrono::steady_clock::now();
    constexpr std::chrono::milliseconds pause{100};
    if (!shown_ || now - last_ < pause) return;
    last_ = now;
    drawn_ = true;
    if (!total_) {
      fmt::print(stderr, "\r{:>12} events", events);
    } else {
      constexpr std::uintmax_t width = 40;
      const std::uintmax_t done = std::min(bytes, *total_);
      fmt::print(stderr, "\r[{:<{}}] {:>3} %  {} events", fmt::format("{:#<{}}", "", done * width / *total_), width, 100 * done / *total_, events);
    }
    std::fflush(stderr);
  }

  /// Takes the line away.
  void clear() {
    if (drawn_) fmt::print(stderr, "\r\x1b[K");
    drawn_ = false;
  }

 private:
  bool shown_, drawn_ = false;
  std::optional<std::uintmax_t> total_;
  std::chrono::steady_clock::time_point last_{};
};
