// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <scifi/alignment/solution.hpp>
#include <scifi/alignment/tracker_parameters.hpp>

/// A mode in words: the parameters that are most of it.
[[nodiscard]] inline std::string in_words(const scifi::alignment::mode& m, const scifi::alignment::tracker_parameters& parameters) {
  std::vector<std::pair<double, int>> parts;
  for (int i = 0; i < parameters.size(); ++i) parts.emplace_back(-std::abs(m.weights[i]), i);
  std::sort(parts.begin(), parts.end());
  std::string out;
  constexpr std::size_t most = 4;
  for (std::size_t k = 0; k < std::min(most, parts.size()) && -parts[k].first > 0.2; ++k)
    out += fmt::format("{}{:+.2f} {}", out.empty() ? "" : ", ", m.weights[parts[k].second], name_of(parameters[parts[k].second]));
  return out;
}
