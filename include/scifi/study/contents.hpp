// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include <scifi/study/sample.hpp>

namespace scifi::study {

/// Adds the same part of another study: `each(merge, other)` is +=.
inline constexpr auto merge = [](auto& mine, const auto& more) { mine += more; };

namespace detail {

struct any_visit {
  template <class Part>
  void operator()(Part&) const {}
};

/// Has parts of its own.
template <class Part>
concept has_parts = requires(Part& part) { part.each(any_visit{}); };

/// Numbers, samples, classes with `each`, histograms of any of these.
template <class Part>
void put(std::vector<double>& out, Part& part) {
  if constexpr (std::is_arithmetic_v<Part>) {
    out.push_back(static_cast<double>(part));
  } else if constexpr (std::is_same_v<Part, sample>) {
    out.push_back(static_cast<double>(part.size()));
    out.insert(out.end(), part.values().begin(), part.values().end());
  } else if constexpr (has_parts<Part>) {
    part.each([&out](auto& p) { put(out, p); });
  } else {
    for (auto& cell : part) put(out, cell);
  }
}

/// Adds what `put` put from the front of `from`. False where it is cut short or no count stands where one has to.
template <class Part>
[[nodiscard]] bool add(std::span<const double>& from, Part& part) {
  if constexpr (std::is_arithmetic_v<Part>) {
    if (from.empty()) return false;
    part += static_cast<Part>(from.front());
    from = from.subspan(1);
    return true;
  } else if constexpr (std::is_same_v<Part, sample>) {
    if (from.empty() || !(from.front() >= 0.0 && from.front() <= static_cast<double>(from.size() - 1)) || from.front() != std::floor(from.front())) return false;
    const auto size = static_cast<std::size_t>(from.front());
    for (const double value : from.subspan(1, size)) part.add(value);
    from = from.subspan(1 + size);
    return true;
  } else if constexpr (has_parts<Part>) {
    bool good = true;
    part.each([&](auto& p) { good = good && add(from, p); });
    return good;
  } else {
    for (auto& cell : part)
      if (!add(from, cell)) return false;
    return true;
  }
}

}  // namespace detail

/// Everything that a study has collected as plain numbers, for another process: bins with under- and overflow, values behind their number. Whole numbers
/// are exact up to 2^53.
template <class Study>
[[nodiscard]] std::vector<double> contents(Study& s) {
  std::vector<double> out;
  detail::put(out, s);
  return out;
}

/// Adds what `contents` gave of a study with the same options and detector. False where it is not of such a one; `s` is of no use then.
template <class Study>
[[nodiscard]] bool add_contents(Study& s, std::span<const double> more) {
  return detail::add(more, s) && more.empty();
}

}  // namespace scifi::study
