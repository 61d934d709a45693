// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <type_traits>

#include <scifi/core/pack.hpp>
#include <scifi/core/trigonometry.hpp>

/// Elementary functions of packs, found by argument-dependent lookup. Series in the reduced argument, cut where the next term is below the rounding error;
/// within 1.5 units in the last place of the true value over the ranges given, sine and cosine of the larger of it and one.
namespace scifi {

namespace detail {

/// c[0] + c[1] x + c[2] x^2 + ..., even and odd powers apart, so that they do not wait for each other.
template <class T, int Lanes, std::size_t Terms>
[[nodiscard, gnu::always_inline]] inline pack<T, Lanes> polynomial(const pack<T, Lanes>& x, const std::array<double, Terms>& c) {
  const pack<T, Lanes> x2 = x * x;
  pack<T, Lanes> last(c[Terms - 1]), before(c[Terms - 2]);
  for (std::size_t i = Terms - 2; i-- > 0;) {
    const pack<T, Lanes> next = last * x2 + pack<T, Lanes>(c[i]);
    last = before;
    before = next;
  }
  return before + x * last;
}

/// How the bits of a number are laid out.
template <class T>
struct layout {
  static constexpr int mantissa = std::numeric_limits<T>::digits - 1;
  static constexpr lane_bits<T> bias = std::numeric_limits<T>::max_exponent - 1;
  static constexpr bool wide = sizeof(T) == 8;
  /// 1.5 times 2 to the number of bits: in n + shift the whole number n stands in the lowest bits.
  static constexpr double shift = wide ? 0x1.8p52 : 0x1.8p23;
  /// ln 2 in two parts, of which the first is so short that its product with an exponent is exact.
  static constexpr double ln2_high = wide ? 0x1.62e42fefa38p-1 : 0x1.62e4p-1;
  static constexpr double ln2_low = wide ? 0x1.ef35793c7673p-45 : 0x1.7f7d1cf79abcap-20;
};

/// The nearest whole number, below 2^50 (float: 2^21): adding and taking away a number so large that no fraction survives.
template <class T, int Lanes>
[[nodiscard, gnu::always_inline]] inline pack<T, Lanes> nearest_whole(const pack<T, Lanes>& x) {
  const pack<T, Lanes> shift(layout<T>::shift);
  return (x + shift) - shift;
}

/// 2^n for whole n, from the bits: the number n + shift has n in its lowest ones.
template <class T, int Lanes>
[[nodiscard, gnu::always_inline]] inline pack<T, Lanes> power_of_two(const pack<T, Lanes>& n) {
  using bits = typename pack_mask<T, Lanes>::vector_type;
  const pack<T, Lanes> shift(layout<T>::shift);
  const bits raised = reinterpret_cast<bits>((n + shift + pack<T, Lanes>(static_cast<T>(layout<T>::bias))).v);
  return pack<T, Lanes>(reinterpret_cast<typename pack<T, Lanes>::vector_type>(raised << layout<T>::mantissa));
}

}  // namespace detail

/// Natural logarithm of a positive normal number; NaN for a negative one or NaN, -infinity for zero and numbers below the smallest normal one, infinity for infinity.
template <class T, int Lanes>
[[nodiscard, gnu::always_inline]] inline pack<T, Lanes> log(const pack<T, Lanes>& x) {
  using scalar = pack<T, Lanes>;
  using bits = typename pack_mask<T, Lanes>::vector_type;
  using vec = typename scalar::vector_type;
  using layout = detail::layout<T>;
  // x = 2^e m with m between sqrt(1/2) and sqrt(2): the exponent of x / sqrt(1/2), and what is left.
  using wrapping = typename detail::lanes_of<std::make_unsigned_t<detail::lane_bits<T>>, Lanes>::type;  // a negative x may pass the ends
  const wrapping raw = reinterpret_cast<wrapping>(x.v);
  const wrapping from = reinterpret_cast<wrapping>(scalar(0.70710678118654752440).v);
  const bits exponent = reinterpret_cast<bits>(raw - from) >> layout::mantissa;
  const scalar m(reinterpret_cast<vec>(raw - (reinterpret_cast<wrapping>(exponent) << layout::mantissa)));
  const scalar shift(layout::shift);
  const scalar e = scalar(reinterpret_cast<vec>(reinterpret_cast<bits>(shift.v) + exponent)) - shift;
  // log m = 2 artanh(s), s = (m - 1)/(m + 1), |s| < 0.1716 (DLMF 4.6.4); the first term is taken out so that it is exact near m = 1.
  const scalar f = m - scalar(1.0);
  const scalar s = f / (m + scalar(1.0));
  const scalar q = s * s;
  scalar series;
  if constexpr (layout::wide) {
    series = detail::polynomial(q, std::array{1.0 / 3, 1.0 / 5, 1.0 / 7, 1.0 / 9, 1.0 / 11, 1.0 / 13, 1.0 / 15, 1.0 / 17, 1.0 / 19, 1.0 / 21});
  } else {
    series = detail::polynomial(q, std::array{1.0 / 3, 1.0 / 5, 1.0 / 7, 1.0 / 9});
  }
  // 2 s = f - s f.
  const scalar log_m = f - s * (f - scalar(2.0) * q * series);
  const scalar finite = e * scalar(layout::ln2_high) + (log_m + e * scalar(layout::ln2_low));
  const scalar largest(std::numeric_limits<T>::max());
  const scalar ordinary = select(x <= largest, finite, x);  // infinity and NaN stay
  const scalar none = select(x < scalar(0.0), scalar(std::numeric_limits<T>::quiet_NaN()), scalar(-std::numeric_limits<T>::infinity()));
  return select(x < scalar(std::numeric_limits<T>::min()), none, ordinary);
}

/// e to the x; zero where it would be below the smallest normal number, infinity where it would be above the largest one.
template <class T, int Lanes>
[[nodiscard]] inline pack<T, Lanes> exp(const pack<T, Lanes>& x) {
  using scalar = pack<T, Lanes>;
  using layout = detail::layout<T>;
  constexpr double lowest = layout::wide ? -708.0 : -87.0;
  constexpr double highest = layout::wide ? 709.0 : 88.0;
  const auto below = x < scalar(lowest);
  const auto above = x > scalar(highest);
  const scalar safe = select(below, scalar(lowest), select(above, scalar(highest), x));
  const scalar n = detail::nearest_whole(scalar(safe * scalar(1.44269504088896340736)));
  const scalar r = (safe - n * scalar(layout::ln2_high)) - n * scalar(layout::ln2_low);  // |r| < 0.35
  scalar tail;  // (e^r - 1 - r) / r^2 (DLMF 4.2.19)
  if constexpr (layout::wide) {
    tail = detail::polynomial(r, std::array{1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720, 1.0 / 5040, 1.0 / 40320, 1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800,
                                        1.0 / 479001600, 1.0 / 6227020800.0});
  } else {
    tail = detail::polynomial(r, std::array{1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720, 1.0 / 5040});
  }
  const scalar power = scalar(1.0) + (r + r * r * tail);
  const scalar value = power * detail::power_of_two(n);
  return select(below, scalar(0.0), select(above, scalar(std::numeric_limits<T>::infinity()), value));
}

namespace detail {

/// Sine and cosine of x = n pi/2 + r, |r| <= pi/4, before the quadrant is put right.
template <class T, int Lanes>
struct reduced_angle {
  using scalar = pack<T, Lanes>;
  using bits = typename pack_mask<T, Lanes>::vector_type;
  scalar sine, cosine;
  bits quadrant;

  [[gnu::always_inline]] explicit reduced_angle(const scalar& x) {
    constexpr bool wide = layout<T>::wide;
    constexpr double largest = wide ? 1.0e5 : 1.0e3;
    const scalar n = nearest_whole(scalar(x * scalar(0.63661977236758134308)));
    quadrant = reinterpret_cast<bits>((n + scalar(layout<T>::shift)).v);
    // pi/2 in three parts, the first two so short that their products with n are exact.
    const scalar reduced = ((x - n * scalar(wide ? 0x1.921fb544p+0 : 0x1.92p+0)) - n * scalar(wide ? 0x1.0b4611a6p-34 : 0x1.fb4p-12)) -
                     n * scalar(wide ? 0x1.3198a2e037073p-69 : 0x1.4442d18469899p-24);
    const scalar r = select(x * x <= scalar(largest * largest), reduced, scalar(std::numeric_limits<T>::quiet_NaN()));
    const scalar q = r * r;
    scalar odd, even;  // (sin r - r)/r^3 and (cos r - 1 + r^2/2)/r^4 (DLMF 4.19.1, 4.19.2)
    if constexpr (wide) {
      odd = polynomial(q, std::array{-1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880, -1.0 / 39916800, 1.0 / 6227020800.0, -1.0 / 1307674368000.0, 1.0 / 355687428096000.0});
      even = polynomial(q, std::array{1.0 / 24, -1.0 / 720, 1.0 / 40320, -1.0 / 3628800, 1.0 / 479001600, -1.0 / 87178291200.0, 1.0 / 20922789888000.0});
    } else {
      odd = polynomial(q, std::array{-1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880});
      even = polynomial(q, std::array{1.0 / 24, -1.0 / 720, 1.0 / 40320, -1.0 / 3628800});
    }
    sine = r + r * q * odd;
    cosine = scalar(1.0) - (q * scalar(0.5) - q * q * even);
  }

  /// The sine of the angle `quadrants` times pi/2 further on.
  [[nodiscard, gnu::always_inline]] scalar sine_after(int quadrants) const {
    const bits at = quadrant + quadrants;
    const scalar value = select(pack_mask<T, Lanes>((at & 1) != 0), cosine, sine);
    return select(pack_mask<T, Lanes>((at & 2) != 0), scalar(-value), value);
  }
};

}  // namespace detail

/// Sine of x (rad), for |x| <= 1e5 (float: 1e3); NaN beyond.
template <class T, int Lanes>
[[nodiscard]] inline pack<T, Lanes> sin(const pack<T, Lanes>& x) {
  return detail::reduced_angle<T, Lanes>(x).sine_after(0);
}

/// Cosine of x (rad), for |x| <= 1e5 (float: 1e3); NaN beyond.
template <class T, int Lanes>
[[nodiscard]] inline pack<T, Lanes> cos(const pack<T, Lanes>& x) {
  return detail::reduced_angle<T, Lanes>(x).sine_after(1);
}

/// Both, from one reduction of the angle.
template <class T, int Lanes>
[[nodiscard]] inline sine_and_cosine<pack<T, Lanes>> sincos_of(const pack<T, Lanes>& x) {
  const detail::reduced_angle<T, Lanes> at(x);
  return {at.sine_after(0), at.sine_after(1)};
}

}  // namespace scifi
