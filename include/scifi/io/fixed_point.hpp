// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>

namespace scifi {

/// Appends a whole number in decimal.
template <std::integral Integer>
void append_integer(std::string& out, Integer value) {
  std::array<char, 24> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  out.append(digits.data(), end);
}

/// Appends `value` with `decimals` digits (0..15) after the point, rounded to nearest; "nan", "inf" or "-inf" where it is one; never "-0.0".
/// The same bytes for the same value everywhere; several times as fast as the C library's conversion.
inline void append_fixed(std::string& out, double value, int decimals) {
  constexpr std::array<double, 16> powers{1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
  constexpr double exact = 9007199254740992.0;  // 2^53: whole numbers below are exact
  const double scaled = std::round(std::abs(value) * powers[static_cast<std::size_t>(decimals)]);
  if (!(scaled < exact)) {
    std::array<char, 400> digits{};
    const auto end = std::isfinite(value) ? std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed, decimals).ptr
                                          : std::to_chars(digits.data(), digits.data() + digits.size(), std::isnan(value) ? std::abs(value) : value).ptr;
    out.append(digits.data(), end);
    return;
  }
  std::array<char, 24> digits{};
  char* const last = digits.data() + digits.size();
  char* at = last;
  auto rest = static_cast<std::uint64_t>(scaled);
  const bool negative = value < 0.0 && rest != 0;
  for (int i = 0; i < decimals; ++i, rest /= 10) *--at = static_cast<char>('0' + rest % 10);
  if (decimals > 0) *--at = '.';
  do {
    *--at = static_cast<char>('0' + rest % 10);
    rest /= 10;
  } while (rest != 0);
  if (negative) *--at = '-';
  out.append(at, last);
}

}  // namespace scifi
