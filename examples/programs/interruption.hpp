// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <atomic>
#include <csignal>
#include <stdexcept>
#include <string>

/// Being asked to stop, by Ctrl-C (SIGINT) or a batch system (SIGTERM). A program that listens finishes what it is at, leaves its files in order and ends;
/// a second signal ends it at once.
namespace interruption {

namespace detail {
inline std::atomic<int> received = 0;  // a handler of signals can reach nothing else
static_assert(std::atomic<int>::is_always_lock_free);
}  // namespace detail

/// The signal that came, or 0.
[[nodiscard]] inline int received() { return detail::received.load(std::memory_order_relaxed); }

/// From now on signals are noted; one that was ignored before (nohup) stays so. A read that waits is interrupted by one.
inline void listen() {
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction before {};
    if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = [](int which) { detail::received.store(which, std::memory_order_relaxed); };
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    ::sigaction(signal, &action, nullptr);
  }
}

class interrupted : public std::runtime_error {
 public:
  /// `what_is_left` tells the user what there is.
  explicit interrupted(const std::string& what_is_left = "nothing was written") : std::runtime_error(std::string("stopped by ") + (received() == SIGINT ? "SIGINT" : "SIGTERM") + "; " + what_is_left) {}
};

inline void throw_if_received() {
  if (received() != 0) throw interrupted();
}

}  // namespace interruption
