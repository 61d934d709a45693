// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <scifi/core/constants.hpp>

namespace scifi {

/// A smooth function of a positive number, laid down as polynomials of seventh degree over sixteenths of octaves: as exact as the function itself, without its
/// logarithms.
///
/// In [2^e (1 + j/16), 2^e (1 + (j + 1)/16)) the polynomial goes through the function at Chebyshev's eight points; of a logarithm what is left out is below
/// 1e-15. A piece in which the polynomial misses the function between its points, at a kink or a step, or in which
/// the function is not a number, is left out and says so.
class octave_polynomials {
 public:
  /// The value and x times its derivative; `known` is false where there is no polynomial.
  struct value_and_slope {
    bool known;
    double value, x_times_slope;
  };

  octave_polynomials() = default;

  /// Of f over the octaves from 2^first; misses of more than 1e-14 of the largest value in a piece leave it out.
  template <class F>
  octave_polynomials(const F& f, int first, int octaves) : first_piece_(static_cast<std::uint64_t>(first + exponent_bias) * pieces) {
    pieces_.reserve(static_cast<std::size_t>(octaves * pieces));
    for (int e = first; e < first + octaves; ++e)
      for (int j = 0; j < pieces; ++j) pieces_.push_back(through(f, std::ldexp(1.0 + (j + 0.5) / pieces, e), std::ldexp(half_width, e)));
  }

  [[nodiscard, gnu::always_inline]] value_and_slope at(double x) const {
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
    const std::uint64_t piece = (bits >> (mantissa_bits - piece_bits)) - first_piece_;
    if (piece >= pieces_.size()) return {false, 0.0, 0.0};
    const std::array<double, terms>& c = pieces_[piece];
    // x / 2^e in [1, 2), and its distance from the middle of the piece.
    constexpr std::uint64_t mantissa = (std::uint64_t(1) << mantissa_bits) - 1, within = mantissa >> piece_bits;
    const double scaled = std::bit_cast<double>((bits & mantissa) | std::bit_cast<std::uint64_t>(1.0));
    const double t = std::bit_cast<double>((bits & within) | std::bit_cast<std::uint64_t>(1.0)) - (1.0 + half_width);
    const double q = t * t;
    // Even and odd terms apart, so that they do not wait for each other: c0 + c2 q + ... and c1 + c3 q + ..., and their derivatives in q.
    const double even = c[0] + q * (c[2] + q * (c[4] + q * c[6]));
    const double odd = c[1] + q * (c[3] + q * (c[5] + q * c[7]));
    const double d_even = c[2] + q * (2.0 * c[4] + q * (3.0 * c[6]));
    const double d_odd = c[3] + q * (2.0 * c[5] + q * (3.0 * c[7]));
    return {c[0] == c[0], even + t * odd, scaled * (odd + 2.0 * (t * d_even + q * d_odd))};
  }

 private:
  static constexpr int mantissa_bits = 52, exponent_bias = 1023, piece_bits = 4, pieces = 1 << piece_bits;
  static constexpr std::size_t terms = 8;
  static constexpr double half_width = 0.5 / pieces;  // of a piece, over 2^e

  /// Coefficients in (x - middle) / 2^e; NaN where there are none.
  template <class F>
  [[nodiscard]] static std::array<double, terms> through(const F& f, double middle, double half) {
    static const std::array<double, 4 * terms> cosine = [] {  // of multiples of pi / (2 terms)
      std::array<double, 4 * terms> out{};
      for (std::size_t k = 0; k < 4 * terms; ++k) out[k] = std::cos(constants::pi * static_cast<double>(k) / (2.0 * terms));
      return out;
    }();
    std::array<double, terms> values{}, c{};
    double largest = 0.0;
    for (std::size_t k = 0; k < terms; ++k) {
      values[k] = f(middle + half * cosine[2 * k + 1]);
      largest = std::fmax(largest, std::fabs(values[k]));
    }
    // Chebyshev's series (Press et al., Numerical Recipes, 5.8), its polynomials T_n turned into powers of s in [-1, 1] as they come.
    std::array<double, terms> before{1.0}, now{0.0, 1.0};
    for (std::size_t n = 0; n < terms; ++n) {
      double sum = 0.0;
      for (std::size_t k = 0; k < terms; ++k) sum += values[k] * cosine[n * (2 * k + 1) % (4 * terms)];
      for (std::size_t i = 0; i < terms; ++i) c[i] += (n == 0 ? 1.0 : 2.0) / terms * sum * before[i];
      std::array<double, terms> next{};
      for (std::size_t i = 0; i < terms; ++i) next[i] = (i > 0 ? 2.0 * now[i - 1] : 0.0) - before[i];
      before = now;
      now = next;
    }
    bool good = true;
    for (std::size_t k = 0; k <= terms; ++k) {
      const double s = cosine[2 * k] * (1.0 - 1e-12);  // between the points and at the ends
      double found = 0.0;
      for (std::size_t i = terms; i-- > 0;) found = found * s + c[i];
      good = good && std::fabs(found - f(middle + half * s)) <= 1e-14 * largest;
    }
    double scale = 1.0;
    for (double& one : c) {
      one *= good ? scale : std::numeric_limits<double>::quiet_NaN();
      scale /= half_width;
    }
    return c;
  }

  std::uint64_t first_piece_ = 0;
  std::vector<std::array<double, terms>> pieces_;
};

}  // namespace scifi
