// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include <scifi/event/digit.hpp>

namespace scifi {

namespace detail {

/// Appends the shortest decimal form that reads back as the same number, a finite one; one that is not of an integer type never looks like one.
template <class Number>
void append_json_number(std::string& out, Number value) {
  std::array<char, 32> room{};
  const std::string_view digits(room.data(), static_cast<std::size_t>(std::to_chars(room.data(), room.data() + room.size(), value).ptr - room.data()));
  out += digits;
  if (std::floating_point<Number> && digits.find_first_of(".e") == std::string_view::npos) out += ".0";
}

}  // namespace detail

/// Appends a line that is one document of the JSON of the MICE experiment's software: a physics spill with one reconstructed event that has
/// digits and nothing made of them, which mice_json_reader reads back exactly. `spill` and `run` are its numbers, not negative. Light
/// must be finite. The digits have no time: it is written as -10, the experiment's own mark for that. Throws std::invalid_argument where a
/// number does not fit.
inline void append_mice_spill(std::string& out, long spill, std::span<const digit> digits, int run = 0) {
  constexpr double no_time = -10.0;  // ns
  if (spill < 0 || spill > std::numeric_limits<int>::max())
    throw std::invalid_argument("event " + std::to_string(spill) + " cannot be the number of a spill: that is 0 .. " +
                                std::to_string(std::numeric_limits<int>::max()));
  if (run < 0) throw std::invalid_argument("run " + std::to_string(run) + " is negative");
  const auto member = [&out](std::string_view name, auto value) {
    out += name;
    detail::append_json_number(out, value);
  };
  member(R"({"maus_event_type":"Spill","daq_event_type":"physics_event","run_number":)", run);
  member(R"(,"spill_number":)", spill);
  out += R"(,"errors":{},"recon_events":[{"part_event_number":0,"sci_fi_event":{"digits":[)";
  bool first = true;
  for (const digit& d : digits) {
    member(first ? R"({"tracker":)" : R"(,{"tracker":)", d.id.tracker);
    member(R"(,"station":)", d.id.station);
    member(R"(,"plane":)", d.id.plane);
    member(R"(,"channel":)", d.id.channel);
    member(R"(,"npe":)", d.npe);
    member(R"(,"time":)", no_time);
    member(R"(,"spill":)", spill);
    out += R"(,"event":0,"used":false})";
    first = false;
  }
  out += R"(],"clusters":[],"spacepoints":[],"straight_pr_tracks":[],"helical_pr_tracks":[],"tracks":[]}}]})";
  out += '\n';
}

}  // namespace scifi
