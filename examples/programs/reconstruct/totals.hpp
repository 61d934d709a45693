// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <chrono>
#include <utility>

#include <scifi/event/event.hpp>

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
  void add(const totals& more);
};

/// The numbers of a `totals` by their names.
inline constexpr std::array counted{
    std::pair{"events", &totals::events},         std::pair{"digits", &totals::digits},       std::pair{"clusters", &totals::clusters},
    std::pair{"space_points", &totals::space_points}, std::pair{"candidates", &totals::candidates}, std::pair{"tracks", &totals::tracks},
    std::pair{"failures", &totals::failures},     std::pair{"flagged", &totals::flagged},     std::pair{"combinations_limited", &totals::combinations_limited},
    std::pair{"fit_failed", &totals::fit_failed}};

inline void totals::add(const totals& more) {
  for (const auto& [name, which] : counted) this->*which += more.*which;
  reconstruction += more.reconstruction;
}
