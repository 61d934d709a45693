// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <system_error>

namespace scifi {

namespace detail {

/// Arithmetic by recursive descent: sums of products of signed factors. `failed_` once something is not understood.
class arithmetic {
 public:
  explicit arithmetic(std::string_view text) : rest_(text) {}

  [[nodiscard]] std::optional<double> value() {
    const double x = sum(0);
    if (failed_ || !rest_.empty() || !std::isfinite(x)) return std::nullopt;
    return x;
  }

 private:
  [[nodiscard]] bool take(char c) {
    if (!rest_.starts_with(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }

  [[nodiscard]] double sum(int depth) {
    double x = product(depth);
    while (!failed_) {
      if (take('+')) x += product(depth);
      else if (take('-')) x -= product(depth);
      else break;
    }
    return x;
  }

  [[nodiscard]] double product(int depth) {
    double x = factor(depth);
    while (!failed_) {
      if (take('*')) x *= factor(depth);
      else if (take('/')) x /= factor(depth);
      else break;
    }
    return x;
  }

  [[nodiscard]] double factor(int depth) {
    constexpr int deepest = 64;
    constexpr std::string_view repeat = "@RepeatNumber";
    if (depth == deepest) return fail();
    if (take('+')) return factor(depth + 1);
    if (take('-')) return -factor(depth + 1);
    if (take('(')) {
      const double inside = sum(depth + 1);
      return take(')') ? inside : fail();
    }
    if (rest_.starts_with(repeat)) {
      rest_.remove_prefix(repeat.size());
      return 0.0;
    }
    // from_chars would also take "inf" and "nan".
    if (rest_.empty() || (rest_[0] != '.' && (rest_[0] < '0' || rest_[0] > '9'))) return fail();
    double x = 0.0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), x);
    if (error != std::errc{}) return fail();
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return x;
  }

  double fail() {
    failed_ = true;
    return 0.0;
  }

  std::string_view rest_;
  bool failed_ = false;
};

}  // namespace detail

/// The value of a number or of an expression in + - * / and parentheses as MiceModules have them, such as `-3300.0+@RepeatNumber*100`.
/// `@RepeatNumber` is 0: the first of the copies. Nothing when the text is not understood or the value is not finite. No blanks.
[[nodiscard]] inline std::optional<double> mice_expression(std::string_view text) { return detail::arithmetic(text).value(); }

}  // namespace scifi
