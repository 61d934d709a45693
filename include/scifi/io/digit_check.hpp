// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <scifi/core/scalar.hpp>
#include <scifi/event/digit.hpp>
#include <scifi/geometry/tracker.hpp>

namespace scifi {

/// Which field of a digit is wrong, and why.
struct digit_fault {
  const char* field;
  std::string reason;
};

/// Tells whether digits fit the detector: indices that exist, light that is finite and not negative, each channel once an event.
/// Constant time a digit. The digits of an event are given one after the other; `position` says where each was found.
class digit_check {
 public:
  /// `position_word` names what positions count, for messages: "line".
  explicit digit_check(const detector& d, const char* position_word) : position_word_(position_word) {
    for (const tracker& t : d.trackers) {
      tracker_entry entry{t.id, {}};
      for (const station& s : t.stations) {
        station_entry planes{s.id, {}};
        for (const plane& p : s.planes) {
          planes.planes.push_back({p.channels, seen_.size()});
          seen_.resize(seen_.size() + static_cast<std::size_t>(p.channels), never);
        }
        entry.stations.push_back(std::move(planes));
      }
      trackers_.push_back(std::move(entry));
    }
  }

  /// Begins an event whose first digit is at `position`; positions must not fall.
  void start_event(long position) { event_start_ = position; }

  /// Nothing when the digit is good, else what is wrong with it.
  [[nodiscard]] std::optional<digit_fault> fault_of(const digit& d, long position) {
    const auto absent = [](const char* what, int number) { return std::string("there is no ") + what + ' ' + std::to_string(number); };
    const tracker_entry* t = find(trackers_, d.id.tracker);
    if (t == nullptr) return digit_fault{"tracker", absent("tracker", d.id.tracker)};
    const station_entry* s = find(t->stations, d.id.station);
    if (s == nullptr) return digit_fault{"station", absent("station", d.id.station) + " in tracker " + std::to_string(d.id.tracker)};
    if (d.id.plane < 0 || static_cast<std::size_t>(d.id.plane) >= s->planes.size())
      return digit_fault{"plane", absent("plane", d.id.plane) + " in station " + std::to_string(d.id.station)};
    const plane_entry& p = s->planes[static_cast<std::size_t>(d.id.plane)];
    if (d.id.channel < 0 || d.id.channel >= p.channels)
      return digit_fault{"channel", std::to_string(d.id.channel) + " is outside 0 .. " + std::to_string(p.channels - 1)};
    if (!is_finite(d.npe)) return digit_fault{"npe", "is not a finite number"};
    if (d.npe < 0.0) return digit_fault{"npe", std::to_string(d.npe) + " is negative"};
    long& seen = seen_[p.first + static_cast<std::size_t>(d.id.channel)];
    if (seen >= event_start_)
      return digit_fault{"channel", "a second digit of channel " + std::to_string(d.id.channel) + " in the event, the first is in " + position_word_ + ' ' +
                                        std::to_string(seen)};
    seen = position;
    return std::nullopt;
  }

 private:
  struct plane_entry {
    int channels;
    std::size_t first;  // index of channel 0 in seen_
  };
  struct station_entry {
    int id;
    std::vector<plane_entry> planes;
  };
  struct tracker_entry {
    int id;
    std::vector<station_entry> stations;
  };

  template <class Entry>
  [[nodiscard]] static const Entry* find(const std::vector<Entry>& entries, int id) {
    for (const Entry& e : entries)
      if (e.id == id) return &e;
    return nullptr;
  }

  static constexpr long never = -1;
  const char* position_word_;
  std::vector<tracker_entry> trackers_;
  std::vector<long> seen_;  // position of the channel's last digit
  long event_start_ = 0;
};

}  // namespace scifi
